// SPDX-License-Identifier: MIT
// The atlas as people look at it: its charts side by side, and what its texels are like.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/pose.h"

namespace lodestone::geometry_image {

struct AtlasPicture {
  uint32_t width = 0, height = 0;
  std::vector<uint32_t>
      texels;         // of each pixel, row by row: a texel of the atlas, or no_index between charts
  double filled = 0;  // the share of the pixels that charts are
};

// Throws Error(machine) naming `subject` where the memory would not hold it.
AtlasPicture lay_out(const Atlas& atlas, const std::string& subject);

// The atlas in one pose, texel by texel.
struct AtlasSurface {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  // for shading, of length 1
  // The L2 stretch of the quads round it (see base_complex/stretch.h), a texel's spacing being that of the
  // mean density: 1 where the quads are squares of the mean size, more where texels are sparse or slanted.
  std::vector<float> stretch;
};
AtlasSurface surface_of(const scene::Scene& scene, const scene::Assembly& assembly, const Atlas& atlas,
                        const scene::Pose& pose);

// Colours of texels, encoded, 0..1. Positions go from 0 to 1 over the bounding box of all.
std::vector<glm::vec3> position_colours(const Atlas& atlas, const AtlasSurface& surface);
std::vector<glm::vec3> normal_colours(const AtlasSurface& surface);
// A colour a chart, shaded a little as the surface would be.
std::vector<glm::vec3> chart_colours(const Atlas& atlas, const AtlasSurface& surface);

}  // namespace lodestone::geometry_image
