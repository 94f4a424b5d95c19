// SPDX-License-Identifier: MIT
// Whether a pose keeps all vertices where 32-bit floats can trace them, told from weights and matrices alone.
#pragma once

#include <vector>

#include "lodestone/scene/pose.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// Coordinates may be as large as this: the product of three of them, which decides how far away a hit is,
// still is a float.
inline constexpr float largest_reach = 1e11f;
// Below this the products of edges lose their last bits.
inline constexpr float smallest_reach = 1e-9f;

class PoseReach {
 public:
  // Visits every triangle and delta, once.
  explicit PoseReach(const Scene& scene);

  // The largest absolute coordinate that a vertex of a node's mesh can have in this pose: never less than
  // what it has, and seldom much more. Not finite where a product overflows.
  float of_node(const Scene& scene, const Pose& pose, uint32_t node) const;

  // Throws Error(bad_input) naming the node where a pose takes vertices farther than `largest_reach` or all
  // of the scene is nearer to the origin than `smallest_reach`.
  void check(const Scene& scene, const Pose& pose) const;

 private:
  struct MeshReach {
    float base = 0;              // of any vertex that a triangle has
    std::vector<float> targets;  // of any vertex's delta
    float influence = 1;         // the largest sum of a vertex's skin weights
  };
  std::vector<MeshReach> meshes_;
};

}  // namespace lodestone::scene
