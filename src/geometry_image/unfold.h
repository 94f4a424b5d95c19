// SPDX-License-Identifier: MIT
// Small triangles that face away from the surface: where the border of a chart is ragged, or its samples are
// far apart for how it bends, two samples may lie on the wrong sides of each other, and the quads between
// them are folded. They hardly matter to distances, but are dark specks in pictures.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/base_complex/cell_map.h"
#include "lodestone/geometry_image/map_lookup.h"

namespace lodestone::geometry_image {

// A sample in space, and which way the surface under it faces: unit length, or zero.
struct Facet {
  glm::dvec3 position, normal;
};

// The place of a point of a cell's map in space.
Facet facet_at(const base_complex::BaseComplex& complex, uint32_t cell, const base_complex::CellMap& map,
               const FacePoint& point);

// Whether a chart of `columns` times `samples.size() / columns` has folded triangles at inner samples.
bool has_folds(uint32_t columns, const std::vector<Facet>& samples);

// Moves samples inside such a chart over its map, until no triangle at them is folded or nothing helps. The
// map's rectangle is the chart's lattice. Those on the border stay; of them only `samples` counts.
void unfold(const base_complex::BaseComplex& complex, uint32_t cell, const base_complex::CellMap& map,
            uint32_t columns, std::vector<Facet>& samples, std::vector<FacePoint>& points);

}  // namespace lodestone::geometry_image
