// SPDX-License-Identifier: MIT
// Ctrl-C. SIGINT and SIGTERM end the program at once with exit code 130, except while something is worth
// keeping.
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
