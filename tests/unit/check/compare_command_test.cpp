// SPDX-License-Identifier: MIT
#include "lodestone/app/compare_command.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "lodestone/base/file.h"
#include "lodestone/image/image.h"
#include "pictures.h"
#include "run_command.h"
#include "temporary_folder.h"

namespace lodestone::app {
namespace {

using image::plain;

class CompareCommand : public image::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    image::Image picture = image::noise(16, 16, 1);
    write(place("a.exr"), picture);
    write(place("same.exr"), picture);
    sample(picture, "G", 3, 4) += 0.25f;
    write(place("other.exr"), picture);
    write(place("small.exr"), plain(8, 8, 0, 0, 0));
  }

  CommandResult compare(const std::string& a, const std::string& b,
                        std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"compare", place(a).string(), place(b).string()});
    return run_command(add_compare_command, options);
  }

  std::string text(const std::string& name) const {
    const std::vector<std::byte> bytes = read_file(place(name));
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
};

TEST_F(CompareCommand, EqualImagesEndWithZero) {
  const CommandResult result = compare("a.exr", "same.exr");
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.output.find("equal\n"), std::string::npos) << result.output;
}

TEST_F(CompareCommand, DifferentImagesEndWithOneAndSayWhere) {
  const CommandResult result = compare("a.exr", "other.exr");
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.output.find("pixel (3, 4), channel G"), std::string::npos) << result.output;
}

TEST_F(CompareCommand, EveryThresholdOptionCanPassAndFail) {
  for (const auto& [option, passing, failing] :
       {std::tuple{"--max", "0.3", "0.2"}, std::tuple{"--mean", "0.01", "1e-6"},
        std::tuple{"--rmse", "0.1", "1e-6"}, std::tuple{"--flip-mean", "0.5", "1e-6"},
        std::tuple{"--flip-p99", "1", "1e-6"}, std::tuple{"--pixel", "0.3", "0.2"},
        std::tuple{"--pixel-share", "0.01", "0.001"}}) {
    EXPECT_EQ(compare("a.exr", "other.exr", {option, passing}).code, 0) << option;
    EXPECT_EQ(compare("a.exr", "other.exr", {option, failing}).code, 1) << option;
  }
  EXPECT_EQ(compare("a.exr", "other.exr", {"--ignore", "G"}).code, 0);
  EXPECT_EQ(compare("a.exr", "other.exr", {"--ignore", "R,B"}).code, 1);
}

TEST_F(CompareCommand, SenselessThresholdsAreWrongUsage) {
  for (const char* value : {"-1", "nan", "inf", "x", ""})
    EXPECT_EQ(compare("a.exr", "same.exr", {"--max", value}).code, 2) << value;
  EXPECT_EQ(compare("a.exr", "same.exr", {"--pixel-share", "1.5"}).code, 2);
  EXPECT_EQ(compare("a.exr", "same.exr", {"--flip-mean", "2"}).code, 2);
}

TEST_F(CompareCommand, JsonGoesToAFileOrAloneToStandardOutput) {
  EXPECT_EQ(compare("a.exr", "other.exr", {"--json", place("out.json").string()}).code, 1);
  EXPECT_EQ(nlohmann::json::parse(text("out.json"))["max"], 0.25);
  const CommandResult result = compare("a.exr", "other.exr", {"--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(result.output)["pass"], false);
}

TEST_F(CompareCommand, QuietPrintsNothing) {
  // The main program sets the level while it parses; so does -q here.
  const CommandResult result = compare("a.exr", "other.exr", {"-q"});
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.output, "");
}

TEST_F(CompareCommand, DifferenceIsWrittenAsAPicture) {
  compare("a.exr", "other.exr", {"--diff", place("diff.png").string()});
  EXPECT_GE(image::read(place("diff.png")).width, 32u);
}

TEST_F(CompareCommand, OtherSizesDifferAndLeaveNoPicture) {
  testing::internal::CaptureStderr();
  const CommandResult result =
      compare("a.exr", "small.exr", {"--diff", place("diff.png").string(), "--max", "9"});
  EXPECT_NE(testing::internal::GetCapturedStderr().find("warning"), std::string::npos);
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.output.find("16 x 16"), std::string::npos) << result.output;
  EXPECT_FALSE(std::filesystem::exists(place("diff.png")));
}

TEST_F(CompareCommand, UnreadableImagesAreBadInput) {
  write_file(place("broken.exr"), std::string("no image"));
  EXPECT_EQ(compare("a.exr", "missing.exr").code, 3);
  EXPECT_EQ(compare("broken.exr", "a.exr").code, 3);
}

TEST_F(CompareCommand, PlacesThatCannotBeWrittenAreNoticed) {
  write_file(place("file"), std::string());
  EXPECT_EQ(compare("a.exr", "same.exr", {"--json", place("file/out.json").string()}).code, 5);
  EXPECT_EQ(compare("a.exr", "same.exr", {"--diff", place("file/out.png").string()}).code, 5);
  EXPECT_EQ(compare("a.exr", "same.exr", {"--diff", place("out.jpg").string()}).code, 2);
}

}  // namespace
}  // namespace lodestone::app
