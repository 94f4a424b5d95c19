// SPDX-License-Identifier: MIT
#include "lodestone/app/check_report.h"

#include <gtest/gtest.h>

namespace lodestone::app {
namespace {

std::vector<GoldenResult> results() {
  GoldenResult passed, failed, broken;
  passed.name = "good";
  passed.seconds = 0.25;
  failed.name = "bad";
  failed.outcome = Outcome::failed;
  failed.problems = {"max is 0.5, above 0.1 <&\">", "second line"};
  failed.pictures = {"bad.img.png"};
  broken.name = "ugly";
  broken.outcome = Outcome::broken;
  broken.problems = {"bytes \xff\x01"};
  return {passed, failed, broken};
}

size_t occurrences(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(JunitReport, CountsAndNamesTests) {
  const std::string xml = junit_report("suite", results());
  EXPECT_NE(xml.find("tests=\"3\" failures=\"1\" errors=\"1\""), std::string::npos) << xml;
  EXPECT_EQ(occurrences(xml, "<testcase "), 3u);
  EXPECT_EQ(occurrences(xml, "<failure "), 1u);
  EXPECT_EQ(occurrences(xml, "<error "), 1u);
  EXPECT_NE(xml.find("name=\"good\" time=\"0.250\"/>"), std::string::npos) << xml;
}

TEST(JunitReport, EscapesWhatXmlCannotHold) {
  const std::string xml = junit_report("a & b", results());
  EXPECT_NE(xml.find("name=\"a &amp; b\""), std::string::npos);
  EXPECT_NE(xml.find("&lt;&amp;&quot;&gt;"), std::string::npos) << xml;
  EXPECT_EQ(xml.find('\xff'), std::string::npos);
  EXPECT_EQ(xml.find('\x01'), std::string::npos);
}

TEST(HtmlReport, ShowsEveryTestAndThePicturesOfThoseThatFailed) {
  const std::string html = html_report("suite", results(), "report_files");
  EXPECT_NE(html.find("3 tests, 2 failed"), std::string::npos) << html;
  for (const char* name : {"good", "bad", "ugly"}) EXPECT_NE(html.find(name), std::string::npos);
  EXPECT_EQ(occurrences(html, "<img "), 1u);
  EXPECT_NE(html.find("src=\"report_files/bad.img.png\""), std::string::npos);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos);  // nothing foreign
  EXPECT_NE(html.find("&lt;&amp;"), std::string::npos);
}

}  // namespace
}  // namespace lodestone::app
