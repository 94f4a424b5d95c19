// SPDX-License-Identifier: MIT
// Scenes that place few meshes many times.
#pragma once

#include "lodestone/scene/scene.h"

namespace lodestone::test {

// A closed bumpy sphere and a square with holes and a normal map, each placed several times: turned, sheared
// by a parent, mirrored, flat along one axis nearly, small and large, some of them in motion; and a floor and
// a deforming ball that are placed once. Clip 0 lasts a second.
scene::Scene grove();

// The sphere `count` times, spread over a cube from -`half` to `half`, each turned and scaled in its own way.
scene::Scene swarm(uint32_t count, float half);

}  // namespace lodestone::test
