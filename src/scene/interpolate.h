// SPDX-License-Identifier: MIT
// The value of an animation channel between its keys.
#pragma once

#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// The value of a valid channel at `time` seconds, clamped to its keys: `width` floats a key. Rotations (x y z
// w) have unit length. Appendix C of glTF 2.0.
std::vector<float> sample_channel(const Channel& channel, float time, size_t width);

// Between unit quaternions along the shorter arc, with unit length; t from 0 to 1.
glm::quat slerp_shortest(const glm::quat& from, const glm::quat& to, float t);

// Unit length; the identity where the length is 0 or not finite.
glm::quat normalized_or_identity(const glm::quat& q);

}  // namespace lodestone::scene
