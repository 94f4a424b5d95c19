// SPDX-License-Identifier: MIT
// How often `path` draws each light: half of the time by power, half of the time any, so that a lamp is not
// lost under a sky whose power is that of all that the scene covers.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/layout/frame.h"

namespace lodestone::render {

// What lights send into a scene, as luminance; all must be finite and none negative.
struct LightPowers {
  double radius = 0;    // of a sphere round the scene
  double sky = 0;       // radiance summed up over all directions
  double emitters = 0;  // area times radiance
};

struct LightChoice {
  uint32_t step = 0;  // layout::PathPush::light_step
  float sky_chance = 0, emitter_chance = 0;
  uint32_t first_emitter_number = 0;  // LightRecord::first_number
};

// Sets first_number and numbers of each light. Those without power are drawn only where all are.
LightChoice choose_lights(std::vector<layout::LightRecord>& lights, const LightPowers& powers);

}  // namespace lodestone::render
