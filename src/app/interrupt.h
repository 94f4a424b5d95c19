// SPDX-License-Identifier: MIT
// Ctrl-C. SIGINT and SIGTERM end the program at once with exit code 130, without a half-written file, except
// while something is worth keeping. So work that keeps nothing before its end, as the baking of an atlas,
// need not ask whether it is wanted.
#pragma once

namespace lodestone::app {

void install_interrupt_handlers();

// While one of these lives, a first signal only makes interrupted() true; a second one kills.
class KeepResults {
 public:
  KeepResults();
  ~KeepResults();
  KeepResults(const KeepResults&) = delete;
  KeepResults& operator=(const KeepResults&) = delete;

 private:
  bool before_;
};

bool interrupted();

}  // namespace lodestone::app
