// SPDX-License-Identifier: MIT
#include "lodestone/test_support/bench_main.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "lodestone/base/error.h"

namespace lodestone::test {
namespace {

struct Outcome {
  int code;
  std::string says;  // on standard error
  bool worked;       // whether the work was begun
};

Outcome outcome(std::array<const char*, 3> arguments, const std::function<void()>& work) {
  int rounds = 0;
  CLI::App app("A bench", "some_bench");
  app.add_option("--rounds", rounds)->check(CLI::Range(1, 9));
  bool worked = false;
  testing::internal::CaptureStderr();
  const int code = bench_main(app, 3, const_cast<char**>(arguments.data()), [&] {
    worked = true;
    work();
  });
  return {code, testing::internal::GetCapturedStderr(), worked};
}

TEST(BenchMain, RefusesWhatItDoesNotKnowBeforeAnythingRuns) {
  const auto nothing = [] {};
  for (const auto& arguments : {std::array{"some_bench", "--rounds", "0"}, {"some_bench", "--round", "3"}}) {
    const Outcome refused = outcome(arguments, nothing);
    EXPECT_EQ(refused.code, 2);
    EXPECT_FALSE(refused.worked);
    EXPECT_EQ(refused.says.rfind("some_bench: ", 0), 0u) << refused.says;
  }
  const Outcome done = outcome({"some_bench", "--rounds", "3"}, nothing);
  EXPECT_EQ(done.code, 0);
  EXPECT_TRUE(done.worked);
}

TEST(BenchMain, ErrorsKeepTheirExitCode) {
  const Outcome device =
      outcome({"some_bench", "--rounds", "3"}, [] { fail(ExitCode::device, "gpu", "is lost"); });
  EXPECT_EQ(device.code, 4);
  EXPECT_EQ(device.says, "some_bench: gpu: is lost\n");
  EXPECT_EQ(outcome({"some_bench", "--rounds", "3"}, [] { throw std::runtime_error("odd"); }).code, 3);
}

}  // namespace
}  // namespace lodestone::test
