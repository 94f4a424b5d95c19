// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lodestone/app/cli.h"

namespace lodestone::app {

// Adds `lodestone check` to the parser; where it is what the user wants, `run` becomes what it does.
// `run_program` runs a command line (without the program's name) in this process, reports its errors and
// returns its exit code.
void add_check_command(CLI::App& app, std::function<int()>& run,
                       std::function<int(const std::vector<std::string>&)> run_program);

}  // namespace lodestone::app
