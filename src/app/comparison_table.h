// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "lodestone/image/compare.h"

namespace lodestone::app {

// A comparison for a terminal: a line a channel, the measures of the whole, and what came of it.
std::string comparison_table(const image::Comparison& comparison);

}  // namespace lodestone::app
