// SPDX-License-Identifier: MIT
#include "lodestone/base/memory.h"

#include <gtest/gtest.h>

#include <fstream>

#include "lodestone/base/error.h"

namespace lodestone {
namespace {

// Stands for /proc and for a control group.
class Memory : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "lodestone_memory_XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const char* name, const char* text) const { std::ofstream(folder_ / name) << text; }
  uint64_t available() const { return available_memory(folder_, folder_); }

  std::filesystem::path folder_;
};

TEST_F(Memory, IsWhatTheKernelEstimates) {
  write("meminfo", "MemTotal:  2048 kB\nMemFree: 12 kB\nMemAvailable:    1000 kB\n");
  EXPECT_EQ(available(), 1000u << 10);
}

TEST_F(Memory, IsWhatTheControlGroupLeavesIfThatIsLess) {
  write("meminfo", "MemAvailable: 1000 kB\n");
  write("memory.max", "500000\n");
  write("memory.current", "200000\n");
  EXPECT_EQ(available(), 300000u);
  write("memory.stat", "anon 7\ninactive_file 50000\n");
  EXPECT_EQ(available(), 350000u);
  write("memory.current", "900000\n");
  EXPECT_EQ(available(), 0u);
}

TEST_F(Memory, IsWhatTheKernelEstimatesWhereTheControlGroupHasNoLimit) {
  write("meminfo", "MemAvailable: 1000 kB\n");
  write("memory.max", "max\n");
  write("memory.current", "200000\n");
  EXPECT_EQ(available(), 1000u << 10);
}

TEST_F(Memory, IsUnlimitedWhereNobodyKnows) {
  EXPECT_EQ(available(), ~uint64_t(0));
}

TEST_F(Memory, ThatIsNotToBeHadIsRefusedByName) {
  require_memory(uint64_t(1) << 20, "a little");
  try {
    require_memory(uint64_t(1) << 60, "the moon");
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::machine);
    EXPECT_NE(std::string(error.what()).find("the moon"), std::string::npos);
  }
}

}  // namespace
}  // namespace lodestone
