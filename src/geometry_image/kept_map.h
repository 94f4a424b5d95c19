// SPDX-License-Identifier: MIT
// From the map of a cell to what an atlas keeps of it (chart_maps.h), for texels that move later.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/base_complex/cell_map.h"
#include "lodestone/geometry_image/chart_maps.h"
#include "lodestone/geometry_image/map_lookup.h"

namespace lodestone::geometry_image {

// The map of a cell as an atlas keeps it, with the texels of a chart whose lattice is the rectangle's, row by
// row; of the inner ones `points` says where in the map they are. `triangles` are those of the assembly that
// the complex was made of.
ChartMaps keep_map(const base_complex::BaseComplex& complex, uint32_t cell, const base_complex::CellMap& map,
                   const std::vector<uint32_t>& triangles, const std::vector<FacePoint>& points,
                   uint32_t columns);

}  // namespace lodestone::geometry_image
