// SPDX-License-Identifier: MIT
// The cost of every pass, as a table for people.
#pragma once

#include <string>
#include <vector>

#include "lodestone/report/measurements.h"

namespace lodestone::report {

// One line a pass behind a heading: calls, milliseconds (of the device where it measured any, else of the
// host), share, invocations, and, where they were counted, memory traffic, rays, node visits and triangle
// tests a ray, and the share of active lanes. What is not known is `-`; a last line says why where it is a
// time.
std::string pass_table(const std::vector<PassSum>& passes);

}  // namespace lodestone::report
