// SPDX-License-Identifier: MIT
// What is wrong with the input's triangles, and which of them get no chart for it. Triangles of grids are
// counted only: they are part of their grid's chart whatever they are.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

enum class TriangleFate : uint8_t {
  kept,
  kept_flat,     // no area in the rest pose, but a pose can open it, or it seals its neighbours to each other
  mapped,        // resampled, as part of a larger chart
  dropped_flat,  // no area in any pose, and the surface is not tighter with it
  dropped_collapsed,  // two corners are one point in every pose
  dropped_duplicate   // a lower triangle has the same corners in the same cyclic order
};

inline bool is_dropped(TriangleFate fate) {
  return fate >= TriangleFate::dropped_flat;
}

inline bool has_own_chart(TriangleFate fate) {
  return fate == TriangleFate::kept || fate == TriangleFate::kept_flat;
}

struct TriangleSurvey {
  std::vector<TriangleFate> fates;  // one a triangle of the assembly; those of grids are never duplicates
  uint64_t boundary_edges = 0;      // of one triangle, among those that are kept and not collapsed
  uint64_t non_manifold_edges = 0;  // of more than two
};

// `welded`: see weld.h. `as_grid`: one a placement, whether it becomes grid charts. A mesh of grids must have
// passed `check_grids`.
TriangleSurvey survey_triangles(const scene::Scene& scene, const scene::Assembly& assembly,
                                const std::vector<uint32_t>& welded, const std::vector<bool>& as_grid);

}  // namespace lodestone::geometry_image
