// SPDX-License-Identifier: MIT
#include "lodestone/app/check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "lodestone/app/comparison_table.h"

namespace lodestone::app {
namespace {

constexpr std::string_view page_head = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{0}</title>
<style>
body {{ font-family: sans-serif; margin: 2em; color: #222; }}
table {{ border-collapse: collapse; }}
th, td {{ text-align: left; padding: 0.2em 1em 0.2em 0; border-bottom: 1px solid #ddd; }}
.passed, .updated {{ color: #070; }}
.failed, .broken, .interrupted {{ color: #b00; }}
figure {{ display: inline-block; margin: 0 1em 1em 0; vertical-align: top; }}
img {{ max-width: 45em; image-rendering: pixelated; border: 1px solid #ddd; }}
pre {{ background: #f4f4f4; padding: 0.5em; overflow: auto; }}
</style>
</head>
<body>
<h1>{0}</h1>
<p>{1} tests, {2} failed, {3:.2f} s</p>
)";

const char* word(Outcome outcome) {
  switch (outcome) {
    case Outcome::passed:
      return "passed";
    case Outcome::updated:
      return "updated";
    case Outcome::failed:
      return "failed";
    case Outcome::broken:
      return "broken";
    case Outcome::interrupted:
      return "interrupted";
  }
  return "";
}

// For text and attributes of XML and HTML alike. What is no UTF-8 becomes U+FFFD, and control characters,
// which XML does not allow, become `?`.
std::string escaped(const std::string& raw) {
  const auto replace = nlohmann::json::error_handler_t::replace;
  const std::string text =
      nlohmann::json::parse(nlohmann::json(raw).dump(-1, ' ', false, replace)).get<std::string>();
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if ((c >= 0 && c < ' ' && c != '\n' && c != '\t') || c == '\x7f')
      result += '?';
    else
      result += c;
  }
  return result;
}

size_t count(const std::vector<GoldenResult>& results, Outcome outcome) {
  return size_t(std::count_if(results.begin(), results.end(),
                              [&](const GoldenResult& result) { return result.outcome == outcome; }));
}

double total_seconds(const std::vector<GoldenResult>& results) {
  double seconds = 0;
  for (const GoldenResult& result : results) seconds += result.seconds;
  return seconds;
}

std::string joined(const std::vector<std::string>& lines) {
  return fmt::format("{}", fmt::join(lines, "\n"));
}

// The measures and the thresholds broken, or why there are none.
std::string details(const GoldenResult& result) {
  return result.comparison ? comparison_table(*result.comparison) : joined(result.problems) + "\n";
}

std::string html_section(const GoldenResult& result, const std::string& pictures) {
  std::string text = fmt::format("<h2 id=\"{0}\">{0}</h2>\n<pre>{1}</pre>\n", escaped(result.name),
                                 escaped(details(result)));
  for (const std::string& picture : result.pictures)
    text += fmt::format("<figure><img src=\"{0}/{1}\" alt=\"{1}\"><figcaption>{1}</figcaption></figure>\n",
                        escaped(pictures), escaped(picture));
  return text;
}

}  // namespace

std::string junit_report(const std::string& suite, const std::vector<GoldenResult>& results) {
  const std::string name = escaped(suite);
  const size_t failures = count(results, Outcome::failed);
  const size_t errors = count(results, Outcome::broken) + count(results, Outcome::interrupted);
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"0\" time=\"{:.3f}\">\n",
      name, results.size(), failures, errors, total_seconds(results));
  for (const GoldenResult& result : results) {
    text += fmt::format("<testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", name, escaped(result.name),
                        result.seconds);
    const char* element = result.outcome == Outcome::failed ? "failure" : "error";
    if (result.good())
      text += "/>\n";
    else
      text +=
          fmt::format("><{0} message=\"{1}\">{2}</{0}></testcase>\n", element,
                      escaped(result.problems.empty() ? "" : result.problems[0]), escaped(details(result)));
  }
  return text + "</testsuite>\n</testsuites>\n";
}

std::string html_report(const std::string& suite, const std::vector<GoldenResult>& results,
                        const std::string& pictures) {
  const size_t bad = results.size() - count(results, Outcome::passed) - count(results, Outcome::updated);
  std::string text = fmt::format(page_head, escaped(suite), results.size(), bad, total_seconds(results));
  text += "<table>\n<tr><th>Test</th><th>Outcome</th><th>Seconds</th><th>Max</th><th>FLIP mean</th></tr>\n";
  for (const GoldenResult& result : results) {
    const std::string name = escaped(result.name);
    const auto& comparison = result.comparison;
    text += fmt::format(
        "<tr><td>{}</td><td class=\"{}\">{}</td><td>{:.2f}</td><td>{}</td><td>{}</td></tr>\n",
        result.good() ? name : fmt::format("<a href=\"#{0}\">{0}</a>", name), word(result.outcome),
        word(result.outcome), result.seconds, comparison ? fmt::format("{:.4g}", comparison->max) : "",
        comparison && comparison->flip_mean ? fmt::format("{:.4g}", *comparison->flip_mean) : "");
  }
  text += "</table>\n";
  for (const GoldenResult& result : results) {
    if (!result.good()) text += html_section(result, pictures);
  }
  return text + "</body>\n</html>\n";
}

}  // namespace lodestone::app
