// SPDX-License-Identifier: MIT
// The surface that an atlas stands for, as a mesh like any other.
#pragma once

#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {

// The two triangles of each quad at a pose, in the order of quad_triangles(): positions to the bit those of
// the geometry image, its normals; no animation, materials or grids.
scene::Scene image_scene(const ReadyScene& ready, const scene::Pose& pose);

}  // namespace lodestone::test
