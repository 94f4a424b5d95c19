// SPDX-License-Identifier: MIT
// What the main() of every bench does: options, then the work, errors as the program says them.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>

namespace lodestone::test {

// Parses the command line with `app` and runs `work`. Returns the exit code: 0, 2 for wrong usage, that of an
// Error, 3 for any other exception; all but 0 with a line on standard error that begins with the app's name.
int bench_main(CLI::App& app, int argc, char** argv, const std::function<void()>& work);

}  // namespace lodestone::test
