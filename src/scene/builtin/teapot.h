// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "lodestone/scene/scene.h"

namespace lodestone::scene::builtin {

// The Utah teapot of teapot_patches.h, a grid a patch, about 14,000 triangles of one material, with the
// normals of the patches. Around a pole, where patches have no width, one square chart lies over the ends of
// four.
//
// It is as open as the original: body, lid, handle and spout are a sheet each, that are closed around and
// hold together by passing through each other. The body ends at the inside of its rim and the lid 0.1 before
// that; handle and spout begin and end inside the body, and the spout's lip inside the spout.
Mesh teapot(const std::string& name, uint32_t material);

}  // namespace lodestone::scene::builtin
