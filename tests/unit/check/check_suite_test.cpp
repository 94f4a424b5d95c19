// SPDX-License-Identifier: MIT
#include "lodestone/app/check_suite.h"

#include <gtest/gtest.h>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "temporary_folder.h"

namespace lodestone::app {
namespace {

class CheckSuite : public image::TemporaryFolder {
 protected:
  GoldenSuite parse(const std::string& text) const {
    write_file(place("suite.json"), text);
    return read_suite(place("suite.json"));
  }

  // The message of the Error(bad_input) of a suite with this one test.
  std::string refusal(const std::string& text) const {
    try {
      parse(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      EXPECT_EQ(std::string(error.what()).find(place("suite.json").string()), 0u) << error.what();
      return error.what();
    }
    return "";
  }
};

TEST_F(CheckSuite, HoldsWhatTheFileSays) {
  const GoldenSuite suite = parse(R"({"tests": [
      {"name": "a", "render": ["builtin:sphere", "--size", "8x8"], "golden": "golden/a.exr"},
      {"name": "b-2.x_", "render": ["{suite}/m.obj"], "golden": "b.png", "thresholds": {
        "max": 1, "mean": 2, "rmse": 3.5, "flip_mean": 0.25, "flip_p99": 1, "pixel": 6, "pixel_share": 0.5,
        "ignore": ["steps.N", "lod.L"]}}]})");
  EXPECT_EQ(suite.name, "suite");
  ASSERT_EQ(suite.tests.size(), 2u);
  EXPECT_EQ(suite.tests[0].name, "a");
  EXPECT_EQ(suite.tests[0].arguments, (std::vector<std::string>{"builtin:sphere", "--size", "8x8"}));
  EXPECT_EQ(suite.tests[0].golden, place("golden/a.exr"));
  EXPECT_FALSE(suite.tests[0].thresholds.max.has_value());
  EXPECT_EQ(suite.tests[1].arguments[0], place("m.obj").string());
  const image::Thresholds& thresholds = suite.tests[1].thresholds;
  EXPECT_EQ(thresholds.max, 1);
  EXPECT_EQ(thresholds.mean, 2);
  EXPECT_EQ(thresholds.rmse, 3.5);
  EXPECT_EQ(thresholds.flip_mean, 0.25);
  EXPECT_EQ(thresholds.flip_p99, 1);
  EXPECT_EQ(thresholds.pixel, 6);
  EXPECT_EQ(thresholds.pixel_share, 0.5);
  EXPECT_EQ(thresholds.ignore, (std::vector<std::string>{"steps.N", "lod.L"}));
}

TEST_F(CheckSuite, RefusesWhatIsNoSuite) {
  for (const char* text : {"", "{", "[]", "null", "{}", R"({"tests": {}})", R"({"tests": []})",
                           R"({"tests": [1]})", R"({"tests": [], "test": []})", "\xff\xfe"})
    EXPECT_NE(refusal(text), "") << text;
  EXPECT_NE(refusal(std::string(1 << 20, '[')).find("nested too deeply"), std::string::npos);
  EXPECT_THROW(read_suite(place("missing.json")), Error);
}

TEST_F(CheckSuite, RefusesTestsThatLackOrMisspellSomething) {
  for (const char* test :
       {R"({"render": ["x"], "golden": "a.exr"})", R"({"name": "a", "golden": "a.exr"})",
        R"({"name": "a", "render": ["x"]})", R"({"name": "a", "render": [], "golden": "a.exr"})",
        R"({"name": "a", "render": "x", "golden": "a.exr"})",
        R"({"name": "a", "render": [1], "golden": "a.exr"})",
        R"({"name": "a", "render": ["x"], "golden": "a.jpg"})",
        R"({"name": 1, "render": ["x"], "golden": "a.exr"})",
        R"({"name": "a", "render": ["x"], "golden": "a.exr", "treshold": {}})",
        R"({"name": "a", "render": ["x"], "golden": "a.exr", "thresholds": {"mx": 1}})",
        R"({"name": "a", "render": ["x"], "golden": "a.exr", "thresholds": {"max": -1}})",
        R"({"name": "a", "render": ["x"], "golden": "a.exr", "thresholds": {"max": "1"}})",
        R"({"name": "a", "render": ["x"], "golden": "a.exr", "thresholds": {"flip_mean": 1.5}})",
        R"({"name": "a", "render": ["x"], "golden": "a.exr", "thresholds": {"ignore": "steps.N"}})",
        R"({"name": "a", "render": ["x"], "golden": "a.exr", "thresholds": []})"})
    EXPECT_NE(refusal(std::string(R"({"tests": [)") + test + "]}"), "") << test;
}

TEST_F(CheckSuite, RefusesNamesThatAreNoFileNames) {
  for (const char* name : {"", ".", "..", ".a", "a/b", "../a", "a b", "a\\\\b", "\\u0000", "\xc3\xa4"})
    EXPECT_NE(refusal(std::string(R"({"tests": [{"name": ")") + name +
                      R"(", "render": ["x"], "golden": "a.exr"}]})"),
              "")
        << name;
}

TEST_F(CheckSuite, RefusesTwoTestsOfOneName) {
  EXPECT_NE(refusal(R"({"tests": [{"name": "a", "render": ["x"], "golden": "a.exr"},
                                  {"name": "a", "render": ["y"], "golden": "b.exr"}]})")
                .find("`a`"),
            std::string::npos);
}

TEST_F(CheckSuite, RefusesArgumentsThatTheCheckSets) {
  for (const char* argument :
       {"-o", "-oa.exr", "--output", "--output=a.exr", "-q", "-v", "--quiet", "--verbose"})
    EXPECT_NE(refusal(std::string(R"({"tests": [{"name": "a", "render": ["x", ")") + argument +
                      R"("], "golden": "a.exr"}]})")
                  .find(argument),
              std::string::npos)
        << argument;
  EXPECT_EQ(
      refusal(R"({"tests": [{"name": "a", "render": ["x", "--view", "linear", "-1"], "golden": "a.exr"}]})"),
      "");
}

}  // namespace
}  // namespace lodestone::app
