// SPDX-License-Identifier: MIT
// An atlas of several objects from those of each.
#pragma once

#include <vector>

#include "lodestone/geometry_image/atlas.h"

namespace lodestone::geometry_image {

// Of each object in the rest pose, where it has the largest of its instances.
std::vector<double> object_areas(const scene::Scene& scene, const scene::Assembly& assembly);

// Puts `part`, the atlas of one object alone, behind what is in `atlas`. `first_triangle`: that object's.
// Throws Error(bad_input), naming `subject`, where there are more texels or slots then than there can be.
void append(const Atlas& part, uint32_t first_triangle, const std::string& subject, Atlas& atlas);

// The stretch of all parts by their areas, as Atlas::report says.
void join_stretch(const std::vector<AtlasReport>& parts, const std::vector<double>& areas, AtlasReport& all);

}  // namespace lodestone::geometry_image
