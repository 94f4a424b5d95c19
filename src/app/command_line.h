// SPDX-License-Identifier: MIT
// The whole program behind main(): parses, runs a command, turns every error into a line and an exit code.
#pragma once

#include <string>
#include <vector>

namespace lodestone::app {

// `arguments` without the program's name. May be called from within a command (`check` renders its suite so);
// the log level is given back as it was.
int run_command_line(const std::vector<std::string>& arguments);

}  // namespace lodestone::app
