// SPDX-License-Identifier: MIT
// How true a geometry image is to the mesh that it stands for.
#pragma once

#include <optional>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/pose.h"

namespace lodestone::geometry_image {

// Distances in the given pose, in units of the diagonal of the input's bounding box.
struct Fidelity {
  double diagonal = 0;                    // in scene units
  double from_input = 0;                  // the farthest that a point of the input is from the geometry image
  double from_image = 0;                  // and the other way round
  double mean = 0, root_mean_square = 0;  // from the input, over its area
  double hausdorff() const { return from_input > from_image ? from_input : from_image; }
};

// Measured at all corners and at points spread over both surfaces (see mesh/distance.h). Nothing where no
// chart is resampled, for the others keep the input's triangles, or where the pose has a position that is no
// finite number. Of an object that is placed many times, the first instance is measured.
std::optional<Fidelity> measure_fidelity(const scene::Scene& scene, const scene::Assembly& assembly,
                                         const Atlas& atlas, const scene::Pose& pose);

}  // namespace lodestone::geometry_image
