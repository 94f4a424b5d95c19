// SPDX-License-Identifier: MIT
// How error falls as a resampled mesh gets more texels: figure 11 of the paper, and distances beside it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/render/backend.h"
#include "lodestone/scene/scene.h"

namespace lodestone::test {

struct SeriesPoint {
  uint32_t resolution = 0;  // asked for: resolution x resolution texels
  uint64_t texels = 0, charts = 0;
  // Between the input and the geometry image in the rest pose, in units of the diagonal (fidelity.h).
  double from_input = 0, from_image = 0, hausdorff = 0, root_mean_square = 0;
  // Between the picture of the charts and that of the input's own triangles: the mean difference of R G B as
  // displayed (0..1), and the mean FLIP error.
  double pixel_error = 0, flip = 0;
};

struct SeriesPicture {
  uint32_t size = 512, spp = 4;  // size x size pixels
  std::string camera;            // as find_view() takes it
};

// One point a resolution, in their order, in the rest pose. Throws Error(bad_input) where nothing of the
// scene can be resampled.
std::vector<SeriesPoint> resolution_series(const scene::Scene& scene,
                                           const std::vector<uint32_t>& resolutions,
                                           const SeriesPicture& picture, render::Backend& backend);

}  // namespace lodestone::test
