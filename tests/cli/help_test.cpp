// SPDX-License-Identifier: MIT
#include <regex>

#include "process.h"

namespace lodestone::cli {
namespace {

class Help : public testing::TestWithParam<const char*> {};

TEST_P(Help, EndsWithAnExampleOfTheCommand) {
  const Result result = run({GetParam(), "--help"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
  const size_t example = result.out.rfind(std::string("Example: lodestone ") + GetParam());
  ASSERT_NE(example, std::string::npos) << result.out;
  EXPECT_EQ(result.out.find('\n', example), result.out.find_last_not_of("\n") + 1)
      << "something follows the example";
}

INSTANTIATE_TEST_SUITE_P(OfEveryCommand, Help,
                         testing::Values("render", "compare", "check", "parity", "bake", "info", "bench",
                                         "devices"),
                         [](const auto& test) { return std::string(test.param); });

TEST(Program, ListsItsCommands) {
  const Result result = run({"--help"});
  EXPECT_EQ(result.code, 0);
  for (const char* command : {"render", "compare", "check", "parity", "bake", "info", "bench", "devices"})
    EXPECT_NE(result.out.find(command), std::string::npos) << command;
}

TEST(Program, SaysItsVersionAndCommit) {
  const Result result = run({"--version"});
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(
      std::regex_match(result.out, std::regex("lodestone \\d+\\.\\d+\\.\\d+ \\(([0-9a-f]{12}|unknown)\\)\n")))
      << result.out;
}

}  // namespace
}  // namespace lodestone::cli
