// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "lodestone/app/cli.h"

namespace lodestone::app {

// Adds `lodestone bench` to the parser; where it is what the user wants, `run` becomes what it does.
void add_bench_command(CLI::App& app, std::function<int()>& run);

}  // namespace lodestone::app
