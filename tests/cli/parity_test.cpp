// SPDX-License-Identifier: MIT
// `lodestone parity`, and --device on a machine with and without Vulkan.
#include <regex>

#include "process.h"

namespace lodestone::cli {
namespace {

const ProcessOptions without_vulkan = {.environment = {{"VK_DRIVER_FILES", "/none.json"}}};

class Parity : public CommandLine {};

TEST_F(Parity, OfADeviceIsEqualAndCanBeLogged) {
  const Result result =
      run({"parity", "builtin:tiny", "--device", "gpu", "--size", "16x16", "--log", place("log.txt")});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(std::regex_search(
      result.out, std::regex("\nparity: equal, \\d+ passes, \\d+ words on .+ against the CPU\n$")))
      << result.out;
  EXPECT_EQ(read_text(place("log.txt")), result.out);
}

TEST_F(Parity, OfTheCpuWithItselfIsWrongUsage) {
  const Result result = run({"parity", "builtin:tiny", "--device", "cpu"});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("--device cpu: would compare the CPU with itself"), std::string::npos)
      << result.err;
}

TEST_F(Parity, FindsAFaultAndNamesThePass) {
  const Result result =
      run({"parity", "builtin:tiny", "--device", "gpu", "--size", "16x16", "--fault", "rasterise:70"});
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.err.find("the pass `rasterise` is the first that differs"), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("first word 2:"), std::string::npos)
      << result.err;  // bit 70 is in the third word
  EXPECT_EQ(result.out.find("parity: equal"), std::string::npos);
}

TEST_F(Parity, KnowsWhichPassesCanBeBroken) {
  const Result result =
      run({"parity", "builtin:tiny", "--device", "gpu", "--size", "16x16", "--fault", "blur:1"});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("there is blend, rasterise, bounds"), std::string::npos) << result.err;
}

TEST_F(Parity, QuietLeavesTheExitCode) {
  const Result result = run({"parity", "builtin:tiny", "--device", "gpu", "--size", "16x16", "-q"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Parity, OfTheFirstVulkanDeviceIsEqual) {
  const Result result =
      run({"parity", "builtin:tiny", "--device", "gpu", "--size", "32x32", "--frames", "0-1"});
  EXPECT_EQ(result.code, 0) << result.err << result.out;
}

TEST_F(Parity, WithoutVulkanThereIsNothingToCompare) {
  const Result result = run({"parity", "builtin:tiny", "--size", "16x16"}, without_vulkan);
  EXPECT_EQ(result.code, 4) << result.err;
}

TEST_F(Parity, WithoutVulkanRenderTakesTheCpuAndWarns) {
  std::vector<std::string> arguments = {"render", "builtin:tiny", "-o", place("x.png"), "--size", "8x8"};
  const Result result = run(arguments, without_vulkan);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("lodestone: warning: no Vulkan device"), std::string::npos) << result.err;
  arguments.insert(arguments.end(), {"--device", "gpu"});
  EXPECT_EQ(run(arguments, without_vulkan).code, 4);
}

TEST_F(Parity, DevicesCanBeNamedByIndexAndByPartOfTheirName) {
  for (const char* device : {"0", "LLVMPIPE"}) {
    const Result result =
        run({"render", "builtin:tiny", "-o", place("x.png"), "--size", "8x8", "--device", device},
            {.environment = {{"VK_DRIVER_FILES", "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json"}},
             .signal_when = {}});
    EXPECT_EQ(result.code, 0) << device << ": " << result.err;
  }
}

}  // namespace
}  // namespace lodestone::cli
