// SPDX-License-Identifier: MIT
// How long each stage of a long piece of work takes; and, on a terminal, which one it is at.
#pragma once

#include <string>
#include <vector>

#include "lodestone/report/measurements.h"

namespace lodestone::app {

class StageClock {
 public:
  // `work`: what the stages are of, for the line on the terminal. Without `show` there is none.
  explicit StageClock(std::string work, bool show = true);
  ~StageClock();
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  // Ends the stage before and begins this one. Stages of one name are added up.
  void begin(const std::string& name);
  void end();

  const std::vector<report::Stage>& stages() const { return stages_; }

 private:
  void clear_line();

  std::string work_, current_;
  std::vector<report::Stage> stages_;
  double since_ = 0;
  bool show_, shown_ = false;
};

// `seams 12 ms, cells 340 ms`.
std::string stage_text(const std::vector<report::Stage>& stages);

}  // namespace lodestone::app
