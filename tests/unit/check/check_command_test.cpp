// SPDX-License-Identifier: MIT
// `lodestone check` with a stand-in for the renderer: `render COLOUR -o FILE -q` writes a plain picture.
#include "lodestone/app/check_command.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "lodestone/base/file.h"
#include "lodestone/image/image.h"
#include "pictures.h"
#include "run_command.h"
#include "temporary_folder.h"

namespace lodestone::app {
namespace {

namespace fs = std::filesystem;

int stand_in(const std::vector<std::string>& arguments) {
  EXPECT_EQ(arguments.at(0), "render");
  const std::string& scene = arguments.at(1);
  if (scene == "fail") return 4;
  if (scene == "interrupt") return 130;
  const auto output = std::find(arguments.begin(), arguments.end(), "-o");
  if (output == arguments.end()) return 2;
  const float grey = std::stof(scene);
  image::Image picture = image::plain(12, 9, grey, grey, grey);
  picture.linear = output[1].ends_with(".exr");
  image::write(output[1], picture);
  return 0;
}

class CheckCommand : public image::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    if (const char* value = std::getenv("CI")) ci_ = value;
    unsetenv("CI");
  }
  void TearDown() override {
    if (!ci_.empty()) setenv("CI", ci_.c_str(), 1);
    TemporaryFolder::TearDown();
  }

  // Tests NAME: SCENE with golden images NAME.exr.
  void write_suite(const std::vector<std::pair<std::string, std::string>>& tests,
                   const std::string& thresholds = "{}", const std::string& extension = ".exr") const {
    std::string text;
    for (const auto& [name, scene] : tests)
      text += (text.empty() ? "" : ",") +
              ("{\"name\": \"" + name + "\", \"render\": [\"" + scene + "\"], \"golden\": \"golden/" + name +
               extension + "\", \"thresholds\": " + thresholds + "}");
    write_file(place("suite.json"), "{\"tests\": [" + text + "]}");
  }
  void write_golden(const std::string& name, float grey) const {
    image::write(place("golden/" + name), image::plain(12, 9, grey, grey, grey));
  }
  CommandResult check(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"check", place("suite.json").string()});
    return run_command(
        [](CLI::App& app, std::function<int()>& run) { add_check_command(app, run, stand_in); }, options);
  }
  std::set<std::string> files(const std::string& folder) const {
    std::set<std::string> names;
    if (!fs::exists(place(folder))) return names;
    for (const fs::directory_entry& entry : fs::directory_iterator(place(folder)))
      names.insert(entry.path().filename().string());
    return names;
  }
  std::string text(const std::string& name) const {
    const std::vector<std::byte> bytes = read_file(place(name));
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }

 private:
  std::string ci_;
};

TEST_F(CheckCommand, PassingSuiteEndsWithZeroAndLeavesNothing) {
  write_suite({{"a", "0.5"}, {"b", "0.25"}});
  write_golden("a.exr", 0.5f);
  write_golden("b.exr", 0.25f);
  const CommandResult result = check({"--out", place("out").string()});
  EXPECT_EQ(result.code, 0) << result.output;
  EXPECT_NE(result.output.find("2 tests, 0 failed"), std::string::npos) << result.output;
  EXPECT_TRUE(files("out").empty());
}

TEST_F(CheckCommand, AnotherPictureFailsAndLeavesTheEvidence) {
  write_suite({{"a", "0.5"}, {"b", "0.25"}});
  write_golden("a.exr", 0.5f);
  write_golden("b.exr", 0.75f);
  const CommandResult result = check({"--out", place("out").string()});
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.output.find("FAILED  b"), std::string::npos) << result.output;
  EXPECT_EQ(files("out"), (std::set<std::string>{"b.img.exr", "b.ref.exr", "b.diff.png"}));
  EXPECT_EQ(image::read(place("out/b.img.exr")).find("R")->values[0], 0.25f);
  EXPECT_EQ(image::read(place("out/b.ref.exr")).find("R")->values[0], 0.75f);
}

TEST_F(CheckCommand, EvidenceOfAnEarlierRunGoes) {
  write_suite({{"a", "0.5"}});
  write_golden("a.exr", 0.25f);
  check({"--out", place("out").string()});
  EXPECT_EQ(files("out").size(), 3u);
  write_golden("a.exr", 0.5f);
  check({"--out", place("out").string()});
  EXPECT_TRUE(files("out").empty());
}

TEST_F(CheckCommand, ThresholdsOfATestDecide) {
  write_golden("a.exr", 0.5f);
  write_suite({{"a", "0.51"}}, R"({"max": 0.02})");
  EXPECT_EQ(check().code, 0);
  write_suite({{"a", "0.51"}}, R"({"max": 0.005})");
  EXPECT_EQ(check().code, 1);
}

TEST_F(CheckCommand, MissingGoldenImageIsAFailure) {
  write_suite({{"a", "0.5"}}, R"({"max": 100})");
  const CommandResult result = check({"--out", place("out").string()});
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.output.find("no golden image"), std::string::npos) << result.output;
  EXPECT_EQ(files("out"), std::set<std::string>{"a.img.exr"});
}

TEST_F(CheckCommand, ADeviceGoesToEveryTestThatNamesNone) {
  write_file(place("suite.json"), R"({"tests": [
    {"name": "a", "render": ["0.5"], "golden": "a.exr"},
    {"name": "b", "render": ["0.5", "--device", "1"], "golden": "b.exr"},
    {"name": "c", "render": ["0.5", "--device=1"], "golden": "c.exr"}]})");
  std::vector<bool> given;
  const auto render = [&](const std::vector<std::string>& arguments) {
    const auto device = std::find(arguments.begin(), arguments.end(), "cpu");
    given.push_back(device != arguments.end() && *(device - 1) == "--device");
    return stand_in(arguments);
  };
  run_command([&](CLI::App& app, std::function<int()>& run) { add_check_command(app, run, render); },
              {"check", place("suite.json").string(), "--device", "cpu"});
  EXPECT_EQ(given, (std::vector<bool>{true, false, false}));
}

TEST_F(CheckCommand, ADifferenceCountsMoreThanAFailedRender) {
  write_suite({{"a", "fail"}, {"b", "0.25"}});
  write_golden("b.exr", 0.5f);
  EXPECT_EQ(check().code, 1);
}

TEST_F(CheckCommand, FailedRenderFailsItsTestAlone) {
  write_suite({{"a", "fail"}, {"b", "0.25"}});
  write_golden("a.exr", 0.5f);
  write_golden("b.exr", 0.25f);
  const CommandResult result = check();
  EXPECT_EQ(result.code, 4);
  EXPECT_NE(result.output.find("exit code 4"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("2 tests, 1 failed"), std::string::npos) << result.output;
}

TEST_F(CheckCommand, UnreadableGoldenImageFailsItsTest) {
  write_suite({{"a", "0.5"}});
  write_file(place("golden/a.exr"), std::string("no image"));
  EXPECT_EQ(check().code, 3);
}

TEST_F(CheckCommand, InterruptionEndsTheSuite) {
  write_suite({{"a", "interrupt"}, {"b", "0.25"}});
  const CommandResult result = check();
  EXPECT_EQ(result.code, 130);
  EXPECT_EQ(result.output.find(" b "), std::string::npos) << result.output;
}

TEST_F(CheckCommand, UpdateWritesMissingAndDifferentGoldenImagesOnly) {
  write_suite({{"same", "0.5"}, {"other", "0.25"}, {"missing", "0.125"}}, R"({"max": 100})");
  image::Image same = image::plain(12, 9, 0.5f, 0.5f, 0.5f);
  same.metadata["note"] = "from an earlier version";
  image::write(place("golden/same.exr"), same);
  const std::vector<std::byte> before = read_file(place("golden/same.exr"));
  write_golden("other.exr", 0.75f);
  const CommandResult result = check({"--update"});
  EXPECT_EQ(result.code, 0) << result.output;
  EXPECT_EQ(read_file(place("golden/same.exr")), before);
  EXPECT_EQ(image::read(place("golden/other.exr")).find("R")->values[0], 0.25f);
  EXPECT_EQ(image::read(place("golden/missing.exr")).find("R")->values[0], 0.125f);
  EXPECT_NE(result.output.find("updated other"), std::string::npos) << result.output;
  write_suite({{"same", "0.5"}, {"other", "0.25"}, {"missing", "0.125"}});
  EXPECT_EQ(check().code, 0);
}

TEST_F(CheckCommand, UpdateIsRefusedInContinuousIntegration) {
  write_suite({{"a", "0.5"}});
  setenv("CI", "true", 1);
  EXPECT_EQ(check({"--update"}).code, 2);
  EXPECT_EQ(check().code, 1);
  unsetenv("CI");
  EXPECT_TRUE(files("golden").empty());
}

TEST_F(CheckCommand, ReportsAreWrittenWithTheirPictures) {
  write_suite({{"a", "0.5"}, {"b", "0.25"}, {"c", "0.125"}});
  write_golden("a.exr", 0.5f);
  write_golden("b.exr", 0.75f);
  EXPECT_EQ(check({"--junit", place("r/junit.xml").string(), "--html", place("r/page.html").string()}).code,
            1);
  EXPECT_NE(text("r/junit.xml").find("tests=\"3\" failures=\"2\" errors=\"0\""), std::string::npos);
  EXPECT_NE(text("r/page.html").find("page_files/b.diff.png"), std::string::npos);
  EXPECT_EQ(files("r/page_files"),
            (std::set<std::string>{"b.img.png", "b.ref.png", "b.diff.png", "c.img.png"}));
  EXPECT_NEAR(image::read(place("r/page_files/b.img.png")).find("R")->values[0], 0.537f, 0.003);  // encoded
}

TEST_F(CheckCommand, PngGoldensAreRenderedAsPng) {
  write_suite({{"a", "0.2"}}, "{}", ".png");
  write_golden("a.png", 0.2f);
  EXPECT_EQ(check().code, 0);
  write_golden("a.png", 0.4f);
  check({"--out", place("out").string()});
  EXPECT_EQ(files("out"), (std::set<std::string>{"a.img.png", "a.ref.png", "a.diff.png"}));
}

TEST_F(CheckCommand, BadSuiteIsBadInput) {
  EXPECT_EQ(check().code, 3);
  write_file(place("suite.json"), std::string("{\"tests\": 1}"));
  EXPECT_EQ(check().code, 3);
}

TEST_F(CheckCommand, QuietPrintsNothing) {
  write_suite({{"a", "0.5"}});
  EXPECT_EQ(check({"-q"}).output, "");
}

}  // namespace
}  // namespace lodestone::app
