// SPDX-License-Identifier: MIT
#include "lodestone/host/driver_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace lodestone::host {
namespace {

namespace fs = std::filesystem;

class DriverFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("lodestone_drivers_" + std::to_string(getpid()));
    fs::create_directories(folder_ / "vulkan/icd.d");
    unsetenv("VK_DRIVER_FILES");
    unsetenv("VK_ICD_FILENAMES");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    const fs::path file = folder_ / name;
    std::ofstream(file) << text;
    return file.string();
  }

  static void expect_contains(const std::string& part) {
    const std::string text = describe_driver_files();
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in \"" << text << "\"";
  }

  fs::path folder_;
};

TEST_F(DriverFiles, AreThoseOfTheEnvironmentWithWhatIsWrong) {
  write("libgood.so", "");
  const std::string good = write("good.json", R"({"ICD": {"library_path": "./libgood.so"}})");
  const std::string bad = write("bad.json", R"({"ICD": {"library_path": "./libbad.so"}})");
  const std::string torn = write("torn.json", R"({"ICD": )");
  const std::string missing = (folder_ / "missing.json").string();
  setenv("VK_ICD_FILENAMES", (good + ":" + bad + ":" + torn + ":" + missing).c_str(), 1);
  expect_contains("VK_ICD_FILENAMES: " + good + ";");
  expect_contains(bad + " (its library ./libbad.so does not exist)");
  expect_contains(torn + " (is no driver file)");
  expect_contains(missing + " (does not exist)");
  setenv("VK_DRIVER_FILES", "", 1);
  expect_contains("VK_DRIVER_FILES is set and names no driver file");
}

TEST_F(DriverFiles, AreLookedForInTheFoldersOfTheLoader) {
  setenv("XDG_DATA_HOME", folder_.c_str(), 1);
  const std::string file = write("vulkan/icd.d/mine.json", R"({"ICD": {"library_path": "libmine.so"}})");
  expect_contains(file);
}

}  // namespace
}  // namespace lodestone::host
