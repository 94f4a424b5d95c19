// SPDX-License-Identifier: MIT
#include "lodestone/base/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <future>
#include <iterator>

#include "lodestone/base/error.h"
#include "lodestone/base/unfinished_files.h"

namespace lodestone {
namespace {

namespace fs = std::filesystem;

class WriteFile : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              (std::string("lodestone-file-") + test->name() + "-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path place(const char* name) const { return folder_ / name; }
  size_t file_count() const {
    return size_t(
        std::distance(fs::recursive_directory_iterator(folder_), fs::recursive_directory_iterator()));
  }
  static std::string text_of(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static ExitCode code_of_writing(const fs::path& path) {
    try {
      write_file(path, std::string("text"));
    } catch (const Error& error) {
      return error.code();
    }
    return ExitCode::done;
  }

 private:
  fs::path folder_;
};

TEST_F(WriteFile, ReplacesAFileAndLeavesNothingBeside) {
  write_file(place("new/a.txt"), std::string("first"));
  write_file(place("new/a.txt"), std::string("second"));
  EXPECT_EQ(text_of(place("new/a.txt")), "second");
  EXPECT_EQ(file_count(), 2u);
}

TEST_F(WriteFile, LeavesNothingWhereTheProgramEndsInTheMiddle) {
  write_file(place("kept.txt"), std::string("kept"));
  std::vector<fs::path> halves;
  for (int i = 0; i < 3; ++i) {
    halves.push_back(temporary_beside(place("a.txt")));
    std::ofstream(halves.back()) << "half";
  }
  commit_file(halves[0], place("a.txt"));
  discard_file(halves[1]);
  EXPECT_FALSE(fs::exists(halves[1]));
  EXPECT_TRUE(fs::exists(halves[2]));
  std::ofstream(halves[0]) << "of someone else by now";
  remove_unfinished_files();  // as the signal handler does
  EXPECT_FALSE(fs::exists(halves[2]));
  EXPECT_EQ(text_of(place("kept.txt")), "kept");
  EXPECT_EQ(text_of(place("a.txt")), "half");
  EXPECT_TRUE(fs::exists(halves[0]));
  discard_file(halves[2]);
}

TEST_F(WriteFile, WritesThroughALinkToItsTarget) {
  fs::create_directories(place("there"));
  write_file(place("there/target.txt"), std::string("old"));
  fs::create_symlink("there/target.txt", place("link.txt"));
  fs::create_symlink("link.txt", place("second.txt"));
  write_file(place("second.txt"), std::string("new"));
  EXPECT_EQ(text_of(place("there/target.txt")), "new");
  EXPECT_TRUE(fs::is_symlink(place("second.txt")) && fs::is_symlink(place("link.txt")));
  EXPECT_EQ(file_count(), 4u);
}

TEST_F(WriteFile, MakesTheMissingTargetOfALink) {
  fs::create_symlink("there/target.txt", place("link.txt"));
  write_file(place("link.txt"), std::string("new"));
  EXPECT_TRUE(fs::is_symlink(place("link.txt")));
  EXPECT_EQ(text_of(place("there/target.txt")), "new");
}

TEST_F(WriteFile, RefusesARingOfLinks) {
  fs::create_symlink("b", place("a"));
  fs::create_symlink("a", place("b"));
  EXPECT_EQ(code_of_writing(place("a")), ExitCode::machine);
  EXPECT_TRUE(fs::is_symlink(place("a")));
  EXPECT_EQ(file_count(), 2u);
}

TEST_F(WriteFile, WritesIntoAPipe) {
  ASSERT_EQ(::mkfifo(place("pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", place("link"));
  for (const char* name : {"pipe", "link"}) {
    auto read = std::async(std::launch::async, [&] { return text_of(place("pipe")); });
    write_file(place(name), std::string("through"));
    EXPECT_EQ(read.get(), "through");
    EXPECT_TRUE(fs::is_fifo(place("pipe")));
  }
  EXPECT_EQ(file_count(), 2u);
}

TEST_F(WriteFile, LeavesADeviceADevice) {
  EXPECT_EQ(code_of_writing("/dev/null"), ExitCode::done);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(code_of_writing("/dev/full"), ExitCode::machine);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  fs::create_symlink("/dev/null", place("link"));
  EXPECT_EQ(code_of_writing(place("link")), ExitCode::done);
  EXPECT_TRUE(fs::is_symlink(place("link")));
}

TEST_F(WriteFile, DoesNotReplaceAFolder) {
  fs::create_directories(place("folder"));
  EXPECT_EQ(code_of_writing(place("folder")), ExitCode::machine);
  EXPECT_TRUE(fs::is_directory(place("folder")));
  EXPECT_EQ(file_count(), 1u);
}

}  // namespace
}  // namespace lodestone
