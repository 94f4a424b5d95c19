// SPDX-License-Identifier: MIT
#include "lodestone/app/stage_clock.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "lodestone/app/clock.h"
#include "lodestone/base/log.h"

namespace lodestone::app {

StageClock::StageClock(std::string work, bool show)
    : work_(std::move(work)),
      show_(show && log::level() != log::Level::quiet && ::isatty(STDERR_FILENO) != 0) {}

StageClock::~StageClock() {
  clear_line();
}

void StageClock::begin(const std::string& name) {
  end();
  current_ = name;
  since_ = now_ms();
  if (!show_) return;
  fmt::print(stderr, "\r\x1b[K{}: {} ...", work_, name);
  std::fflush(stderr);
  shown_ = true;
}

void StageClock::end() {
  clear_line();
  if (current_.empty()) return;
  const double took = now_ms() - since_;
  const auto known = std::find_if(stages_.begin(), stages_.end(),
                                  [&](const report::Stage& stage) { return stage.name == current_; });
  if (known != stages_.end()) {
    known->wall_ms += took;
  } else {
    stages_.push_back({current_, since_, took});
  }
  current_.clear();
}

void StageClock::clear_line() {
  if (!shown_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  shown_ = false;
}

std::string stage_text(const std::vector<report::Stage>& stages) {
  std::string text;
  for (const report::Stage& stage : stages)
    text += fmt::format("{}{} {:.0f} ms", text.empty() ? "" : ", ", stage.name, stage.wall_ms);
  return text;
}

}  // namespace lodestone::app
