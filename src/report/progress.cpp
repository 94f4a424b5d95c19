// SPDX-License-Identifier: MIT
#include "lodestone/report/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <utility>

namespace lodestone::report {
namespace {

constexpr double redraw_seconds = 0.1;  // of a terminal's line, at most so often
constexpr double line_seconds = 10;     // between plain lines, so that a log stays readable

}  // namespace

std::string duration_text(double seconds) {
  const uint64_t whole = uint64_t(std::llround(std::fmax(seconds, 0)));
  const uint64_t minutes = whole / 60 % 60, hours = whole / 3600;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
  return fmt::format("{}:{:02}", minutes, whole % 60);
}

Progress::Output Progress::standard_error() {
  return {
      .write =
          [](const std::string& text) {
            std::fwrite(text.data(), 1, text.size(), stderr);
            std::fflush(stderr);
          },
      .terminal = ::isatty(STDERR_FILENO) == 1,
      .seconds =
          [] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
          }};
}

Progress::Progress(ProgressMode mode, uint32_t frames, Output output)
    : mode_(mode),
      frames_(frames),
      output_(std::move(output)),
      begin_(output_.seconds()),
      last_done_(begin_),
      last_print_(begin_) {}

Progress::~Progress() {
  clear();
}

std::optional<double> Progress::seconds_left() const {
  if (done_ == 0) return std::nullopt;
  // From whole frames: in the middle of one, the time that it has taken counts down, not up.
  const double a_frame = (last_done_ - begin_) / done_;
  return std::fmax(a_frame * (frames_ - done_) - (output_.seconds() - last_done_), 0);
}

std::string Progress::line() const {
  const std::optional<double> left = seconds_left();
  return fmt::format(
      "frame {} of {}, {} %, {}", done_, frames_, frames_ == 0 ? 100 : 100ull * done_ / frames_,
      left ? duration_text(*left) + " left" : duration_text(output_.seconds() - begin_) + " gone");
}

void Progress::redraw() {
  const std::string text = line();
  output_.write(fmt::format("\r{:{}}", text, drawn_));  // as long as what stands there
  drawn_ = text.size();
  last_print_ = output_.seconds();
}

void Progress::clear() {
  if (drawn_ == 0) return;
  output_.write(fmt::format("\r{:{}}\r", "", drawn_));
  drawn_ = 0;
}

void Progress::frame_done() {
  ++done_;
  last_done_ = output_.seconds();
  if (mode_ == ProgressMode::json) {
    output_.write(fmt::format("{{\"frame\":{},\"frames\":{},\"seconds_left\":{:.3f}}}\n", done_, frames_,
                              seconds_left().value_or(0)));
  } else if (mode_ == ProgressMode::automatic && output_.terminal) {
    redraw();
  } else if (mode_ == ProgressMode::automatic && output_.seconds() - last_print_ >= line_seconds) {
    output_.write("lodestone: " + line() + "\n");
    last_print_ = output_.seconds();
  }
}

void Progress::tick() {
  if (mode_ != ProgressMode::automatic || !output_.terminal) return;
  if (output_.seconds() - last_print_ >= redraw_seconds) redraw();
}

}  // namespace lodestone::report
