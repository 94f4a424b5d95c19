// SPDX-License-Identifier: MIT
#include "lodestone/app/check_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"

namespace lodestone::app {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr uint64_t largest_suite = uint64_t(1) << 24;  // bytes

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= 100 && text[0] != '.' &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return c < 128 && (std::isalnum(c) || c == '_' || c == '-' || c == '.');
         });
}

// Whether an argument is -o, -q or -v in one of the forms that the parser knows.
bool is_taken(std::string_view argument) {
  if (!argument.starts_with("--"))
    return argument.size() > 1 && argument[0] == '-' &&
           std::string_view("oqv").find(argument[1]) != std::string_view::npos;
  const std::string_view name = argument.substr(0, argument.find('='));
  return name == "--output" || name == "--quiet" || name == "--verbose";
}

// Reads one suite; every error names the file and the place in it.
class SuiteReader {
 public:
  explicit SuiteReader(const fs::path& file) : file_(file) {}

  GoldenSuite read() const {
    const std::vector<std::byte> bytes = read_file(file_, largest_suite);
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    const Json json = parse(std::string_view(text, bytes.size()));
    check_keys(json, "the suite", {"tests"});
    GoldenSuite suite;
    suite.name = file_.stem().string();
    std::set<std::string> names;
    const Json& tests = member(json, "the suite", "tests");
    if (!tests.is_array() || tests.empty()) fail("`tests` is no list of tests");
    for (size_t i = 0; i < tests.size(); ++i) {
      suite.tests.push_back(read_test(tests[i], fmt::format("test {}", i + 1)));
      if (!names.insert(suite.tests.back().name).second)
        fail("two tests are named `{}`", suite.tests.back().name);
    }
    return suite;
  }

 private:
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    fail_input(file_.string(), "{}; see `lodestone check --help`",
               fmt::format(format, std::forward<Args>(args)...));
  }

  // Deep nesting would exhaust the stack of the parser's destructor; a suite needs four levels.
  Json parse(std::string_view text) const {
    const auto keep = [this](int depth, Json::parse_event_t, Json&) {
      if (depth > 8) fail("is nested too deeply");
      return true;
    };
    try {
      return Json::parse(text, keep);
    } catch (const Json::exception& error) {
      fail_input(file_.string(), "is not valid JSON: {}", error.what());
    }
  }

  // A misspelt key must not be a check left out.
  void check_keys(const Json& object, const std::string& where,
                  std::initializer_list<const char*> known) const {
    if (!object.is_object()) fail("{} is no object", where);
    for (const auto& [key, value] : object.items()) {
      if (std::find(known.begin(), known.end(), key) == known.end())
        fail("{} has an unknown member `{}`", where, key);
    }
  }

  const Json& member(const Json& object, const std::string& where, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) fail("{} lacks `{}`", where, key);
    return *found;
  }

  std::string text(const Json& value, const std::string& where, const char* key) const {
    if (!value.is_string() || value.get<std::string>().find('\0') != std::string::npos)
      fail("`{}` of {} is no text", key, where);
    return value.get<std::string>();
  }

  std::vector<std::string> texts(const Json& value, const std::string& where, const char* key) const {
    if (!value.is_array()) fail("`{}` of {} is no list of texts", key, where);
    std::vector<std::string> list;
    for (const Json& element : value) list.push_back(text(element, where, key));
    return list;
  }

  GoldenTest read_test(const Json& json, const std::string& where) const {
    check_keys(json, where, {"name", "render", "golden", "thresholds"});
    GoldenTest test;
    test.name = text(member(json, where, "name"), where, "name");
    if (!is_name(test.name))
      fail("`name` of {} must name a file: letters, digits, `_`, `-` and `.` within", where);
    const std::string named = fmt::format("{} ({})", where, test.name);
    test.arguments = read_arguments(member(json, named, "render"), named);
    test.golden = folder() / text(member(json, named, "golden"), named, "golden");
    const std::string extension = test.golden.extension().string();
    if (extension != ".exr" && extension != ".png")
      fail("`golden` of {} ends in neither .exr nor .png", named);
    if (const auto thresholds = json.find("thresholds"); thresholds != json.end())
      test.thresholds = read_thresholds(*thresholds, "`thresholds` of " + named);
    return test;
  }

  fs::path folder() const { return file_.has_parent_path() ? file_.parent_path() : fs::path("."); }

  std::vector<std::string> read_arguments(const Json& json, const std::string& where) const {
    std::vector<std::string> arguments = texts(json, where, "render");
    if (arguments.empty()) fail("`render` of {} is empty", where);
    for (std::string& argument : arguments) {
      if (is_taken(argument)) fail("`render` of {} holds `{}`, which the check itself sets", where, argument);
      constexpr std::string_view placeholder = "{suite}";
      for (size_t at = argument.find(placeholder); at != std::string::npos;
           at = argument.find(placeholder, at)) {
        argument.replace(at, placeholder.size(), folder().string());
        at += folder().string().size();
      }
    }
    return arguments;
  }

  double bound(const Json& value, const std::string& where, const std::string& key, double most) const {
    if (!value.is_number() || !(value.get<double>() >= 0 && value.get<double>() <= most))
      fail("`{}` in {} is no number from 0 to {:g}", key, where, most);
    return value.get<double>();
  }

  image::Thresholds read_thresholds(const Json& json, const std::string& where) const {
    check_keys(json, where,
               {"max", "mean", "rmse", "flip_mean", "flip_p99", "pixel", "pixel_share", "ignore"});
    constexpr double largest = std::numeric_limits<double>::max();
    image::Thresholds thresholds;
    for (const auto& [key, value] : json.items()) {
      if (key == "max") thresholds.max = bound(value, where, key, largest);
      if (key == "mean") thresholds.mean = bound(value, where, key, largest);
      if (key == "rmse") thresholds.rmse = bound(value, where, key, largest);
      if (key == "flip_mean") thresholds.flip_mean = bound(value, where, key, 1);
      if (key == "flip_p99") thresholds.flip_p99 = bound(value, where, key, 1);
      if (key == "pixel") thresholds.pixel = bound(value, where, key, largest);
      if (key == "pixel_share") thresholds.pixel_share = bound(value, where, key, 1);
      if (key == "ignore") thresholds.ignore = texts(value, where, "ignore");
    }
    return thresholds;
  }

  fs::path file_;
};

}  // namespace

GoldenSuite read_suite(const fs::path& file) {
  return SuiteReader(file).read();
}

}  // namespace lodestone::app
