// SPDX-License-Identifier: MIT
// Runs one command in the test's process.
#pragma once

#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/log.h"

namespace lodestone::app {

struct CommandResult {
  int code = -1;      // what the command returned, or the code of the Error it threw
  std::string error;  // its message
  std::string output;
};

inline CommandResult run_command(const std::function<void(CLI::App&, std::function<int()>&)>& add,
                                 std::vector<std::string> arguments) {
  CommandResult result;
  const log::Level level = log::level();
  testing::internal::CaptureStdout();
  try {
    CLI::App app;
    std::function<int()> run;
    add(app, run);
    std::reverse(arguments.begin(), arguments.end());
    app.parse(arguments);
    result.code = run();
  } catch (const Error& error) {
    result.code = int(error.code());
    result.error = error.what();
  } catch (const CLI::ParseError& error) {
    result.code = int(ExitCode::usage);
    result.error = error.what();
  }
  result.output = testing::internal::GetCapturedStdout();
  log::set_level(level);
  return result;
}

}  // namespace lodestone::app
