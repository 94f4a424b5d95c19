// SPDX-License-Identifier: MIT
// Which meshes of a scene are traced once and placed many times.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// `on`: a mesh that nothing deforms is an object of its own where several nodes place it or an animation
// moves its node; all else is one object in the world. `off`: everything is. `automatic`: on where that at
// least halves the triangles.
enum class Instancing : uint32_t { automatic, on, off };

struct Instance {
  uint32_t object = 0;
  uint32_t node = none;  // whose transform places it; none: it is in the world as it is
};

struct ObjectNodes {
  std::vector<uint32_t> nodes;  // of rigid objects one: the first that places the mesh
  bool rigid = false;
};

struct Division {
  std::vector<ObjectNodes> objects;  // rigid ones first, in the order of their meshes
  std::vector<Instance> instances;   // those of rigid objects in node order, then that of the world
};

Division divide(const Scene& scene, Instancing instancing);

}  // namespace lodestone::scene
