// SPDX-License-Identifier: MIT
// Runs the program and tells what it did.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lodestone::cli {

struct Result {
  int code = 0;  // exit code; 128 + N where signal N ended it
  std::string out, err;
  double seconds_after_signal = 0;  // that it went on; 0 where it got none
};

struct ProcessOptions {
  std::map<std::string, std::string> environment{};  // on top of the test's own
  std::chrono::seconds limit{240};                   // then it is killed, and the test fails
  std::string output{};  // a file that standard output goes to; empty: Result::out
  // Asked every few milliseconds; the first time that it says yes the program gets `signal`.
  std::function<bool(const Result& so_far)> signal_when{};
  int signal = 0;
  bool terminal = false;  // standard error is one
};

// The program with these arguments, its cache in a folder that this run of the tests shares.
Result run(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

// A folder of its own for every test, removed after it.
class CommandLine : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  std::string place(const std::string& name) const { return (folder_ / name).string(); }
  std::vector<std::string> files() const;  // the names in the folder, sorted

 private:
  std::filesystem::path folder_;
};

std::string read_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, const std::string& text);

// `render builtin:tiny` and `more`, tiny and on the CPU.
std::vector<std::string> tiny_render(const std::string& output, const std::vector<std::string>& more = {});

}  // namespace lodestone::cli
