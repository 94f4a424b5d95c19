// SPDX-License-Identifier: MIT
// The performance of the head: two seconds that loop without a seam.
#pragma once

#include "lodestone/scene/scene.h"

namespace lodestone::scene::builtin {

// A clip that moves the weights of every node whose mesh has blendshapes, and turns `head_node`.
Animation expressions_clip(const Scene& scene, uint32_t head_node);

}  // namespace lodestone::scene::builtin
