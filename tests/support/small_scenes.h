// SPDX-License-Identifier: MIT
// Scenes of a few quads, made by hand for one question each.
#pragma once

#include "lodestone/scene/scene.h"

namespace lodestone::test {

// A square in the plane z = `z`, from -1 to 1, facing +z, with texture coordinates as glTF has them (v down).
scene::Mesh square(float z, uint32_t material);

// Seen straight from z = 3 through an orthographic camera that shows -1.5 to 1.5, lit by a white sky alone.
// Meshes get a node each.
scene::Scene facing_camera(std::vector<scene::Mesh> meshes, std::vector<scene::Material> materials);

}  // namespace lodestone::test
