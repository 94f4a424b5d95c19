// SPDX-License-Identifier: MIT
// A box round all vertices of a pose, told from weights and matrices alone.
#pragma once

#include <vector>

#include "lodestone/scene/pose.h"
#include "lodestone/scene/pose_reach.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene {

class PoseBox {
 public:
  // Visits every triangle and delta, once.
  explicit PoseBox(const Scene& scene);

  // Holds every vertex that a triangle has, as computed in floats by any of the back ends. Exact but for a
  // margin of 2^-13 of the largest coordinate where no mesh has a skin; with skins seldom more than a few
  // times as large as need be. Empty where there are no triangles.
  Bounds of(const Scene& scene, const Pose& pose) const;
  // The same of one node's mesh, in the world and in its own space.
  Bounds of_node(const Scene& scene, const Pose& pose, uint32_t node) const;
  Bounds of_mesh(uint32_t mesh) const;

 private:
  struct MeshBox {
    Bounds base;
    std::vector<Bounds> targets;  // of deltas, and of 0
    float least = 1, most = 1;    // sums of a vertex's skin weights
    bool mixes = true;            // no weight is negative
  };

  PoseReach reach_;
  std::vector<MeshBox> meshes_;
};

}  // namespace lodestone::scene
