// SPDX-License-Identifier: MIT
// What came of a suite, for continuous integration and for people.
#pragma once

#include <string>
#include <vector>

#include "lodestone/app/check_run.h"

namespace lodestone::app {

// JUnit XML: a <failure> where a picture is another one, an <error> where there was none to compare.
std::string junit_report(const std::string& suite, const std::vector<GoldenResult>& results);

// One HTML page without scripts or foreign files; the pictures of tests that fail are expected in `pictures`,
// a path relative to the page.
std::string html_report(const std::string& suite, const std::vector<GoldenResult>& results,
                        const std::string& pictures);

}  // namespace lodestone::app
