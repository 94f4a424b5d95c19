// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include "lodestone/app/clock.h"
#include "lodestone/app/command_line.h"
#include "lodestone/app/interrupt.h"

int main(int count, char** arguments) {
  lodestone::app::now_ms();  // starts the clock
  lodestone::app::install_interrupt_handlers();
  return lodestone::app::run_command_line(std::vector<std::string>(arguments + 1, arguments + count));
}
