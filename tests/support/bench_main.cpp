// SPDX-License-Identifier: MIT
#include "lodestone/test_support/bench_main.h"

#include "lodestone/base/error.h"

namespace lodestone::test {
namespace {

int failed(const CLI::App& app, const std::exception& error, ExitCode code) {
  fmt::print(stderr, "{}: {}\n", app.get_name(), error.what());
  return int(code);
}

}  // namespace

int bench_main(CLI::App& app, int argc, char** argv, const std::function<void()>& work) {
  try {
    app.parse(argc, argv);
    work();
    return int(ExitCode::done);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return failed(app, error, ExitCode::usage);
  } catch (const Error& error) {
    return failed(app, error, error.code());
  } catch (const std::exception& error) {
    return failed(app, error, ExitCode::bad_input);
  }
}

}  // namespace lodestone::test
