// SPDX-License-Identifier: MIT
#include "lodestone/app/command_line.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <new>
#include <system_error>

#include "lodestone/app/bake_command.h"
#include "lodestone/app/bench_command.h"
#include "lodestone/app/check_command.h"
#include "lodestone/app/compare_command.h"
#include "lodestone/app/devices_command.h"
#include "lodestone/app/info_command.h"
#include "lodestone/app/open_device.h"
#include "lodestone/app/parity_command.h"
#include "lodestone/app/parse_values.h"
#include "lodestone/app/render_command.h"
#include "lodestone/app/version.h"
#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/base/nearest_name.h"
#include "lodestone/base/plain_line.h"

namespace lodestone::app {
namespace {

class LogLevelGuard {
 public:
  LogLevelGuard() : before_(log::level()) {}
  ~LogLevelGuard() { log::set_level(before_); }
  LogLevelGuard(const LogLevelGuard&) = delete;
  LogLevelGuard& operator=(const LogLevelGuard&) = delete;

 private:
  log::Level before_;
};

int report(ExitCode code, const std::string& message) {
  fmt::print(stderr, "lodestone: error: {}\n", plain_line(message));
  return int(code);
}

[[noreturn]] void fail_output() {
  fail(ExitCode::machine, "standard output", "cannot be written: {}", std::strerror(errno));
}

void add_commands(CLI::App& app, std::function<int()>& run) {
  add_render_command(app, run);
  add_compare_command(app, run);
  add_check_command(app, run, run_command_line);
  add_parity_command(app, run);
  add_bake_command(app, run);
  add_info_command(app, run);
  add_bench_command(app, run);
  add_devices_command(app, run);
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

// "; see `lodestone render --help`", of the command that was being parsed.
std::string help_hint(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return fmt::format("; see `lodestone {}--help`", parsed.empty() ? "" : parsed.back()->get_name() + " ");
}

// What is wrong with the first option that the command does not have; empty where it has all of them.
std::string unknown_option(const CLI::App& app, const std::vector<std::string>& arguments) {
  const auto parsed = app.get_subcommands();
  const CLI::App& command = parsed.empty() ? app : *parsed.back();
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (!name.starts_with("--") || command.get_option_no_throw(name) != nullptr) continue;
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& long_name : option->get_lnames()) known.push_back("--" + long_name);
    }
    if (const auto meant = nearest_name(name, known))
      return fmt::format("{}: there is no such option; did you mean {}?", name, *meant);
    return name + ": there is no such option";
  }
  return "";
}

// CLI11's words where they say what is wrong, plainer ones where they count.
std::string plain_words(const CLI::ParseError& error, const CLI::App& app,
                        const std::vector<std::string>& arguments) {
  const std::string words = error.what();
  const std::string option = words.substr(0, words.find(':'));
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::string unknown = unknown_option(app, arguments);
    if (!unknown.empty()) return unknown;
  }
  if (words.find("At Most 1 required but received") != std::string::npos)
    return option + ": is given more than once";
  if (words.find(" required ") != std::string::npos && words.ends_with("missing"))
    return option + ": its value is missing";
  return words;
}

// What is to be run; nothing where the parser has already answered (`--help`, `--version`).
std::function<int()> parse(CLI::App& app, const std::vector<std::string>& arguments,
                           std::function<int()>& run) {
  // CLI11 would call an unknown command an unexpected argument.
  if (!arguments.empty() && !arguments[0].starts_with('-'))
    parse_choice("command", arguments[0], command_names(app));
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());  // as CLI11 wants it
    app.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      app.exit(error);
      return [] { return int(ExitCode::done); };
    }
    throw Error(ExitCode::usage, plain_words(error, app, arguments) + help_hint(app));
  }
  if (!run) throw Error(ExitCode::usage, "a command is missing" + help_hint(app));
  return run;
}

}  // namespace

int run_command_line(const std::vector<std::string>& arguments) {
  const LogLevelGuard guard;
  try {
    CLI::App app("Ray tracing of deforming and massive models in portable compute shaders", "lodestone");
    app.set_version_flag("--version", fmt::format("lodestone {} ({})", version(), commit()));
    app.require_subcommand(0, 1);
    app.get_formatter()->column_width(28);
    app.footer("Example: lodestone render builtin:head -o head.png");
    std::function<int()> run;
    add_commands(app, run);
    const int code = parse(app, arguments, run)();
    fail_on_late_messages();
    if (std::fflush(stdout) != 0) fail_output();
    return code;
  } catch (const Error& error) {
    return report(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return report(ExitCode::machine, "memory: there is not enough of it; choose a smaller scene or picture");
  } catch (const std::system_error& error) {
    return report(ExitCode::machine, fmt::format("system: {}", error.what()));
  } catch (const std::exception& error) {
    return report(ExitCode::machine, fmt::format("internal: {}; please report this", error.what()));
  }
}

}  // namespace lodestone::app
