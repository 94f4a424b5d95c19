// SPDX-License-Identifier: MIT
// The errors that a user can see, and the exit code each ends the program with.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace lodestone {

enum class ExitCode : int {
  done = 0,
  different = 1,  // a comparison found a difference
  usage = 2,      // wrong usage of the command line
  bad_input = 3,  // a file is truncated, absurd or hostile
  device = 4,     // no usable device, or it failed
  machine = 5,    // disk full, out of memory
  interrupted = 130
};

// what() reads `SUBJECT: what is wrong, where, and what to do`; the program prints it as one line behind
// `lodestone: error: `. SUBJECT is a file, an option or a device.
class Error : public std::runtime_error {
 public:
  Error(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code_(exit_code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

template <class... Args>
[[noreturn]] void fail(ExitCode code, const std::string& subject, fmt::format_string<Args...> format,
                       Args&&... args) {
  throw Error(code, subject + ": " + fmt::format(format, std::forward<Args>(args)...));
}

// A bad input file: exit code 3.
template <class... Args>
[[noreturn]] void fail_input(const std::string& file, fmt::format_string<Args...> format, Args&&... args) {
  throw Error(ExitCode::bad_input, file + ": " + fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace lodestone
