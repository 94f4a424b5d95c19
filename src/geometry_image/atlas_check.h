// SPDX-License-Identifier: MIT
// The promises of atlas.h and shaders/layout/atlas.h, checked: kernels follow these indices without looking.
#pragma once

#include <string>

#include "lodestone/geometry_image/atlas.h"

namespace lodestone::geometry_image {

// Empty, or what is wrong with the atlas, in a few words. Triangles are held against `report.triangles`.
std::string find_fault(const Atlas& atlas);

}  // namespace lodestone::geometry_image
