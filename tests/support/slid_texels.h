// SPDX-License-Identifier: MIT
// Levels of detail by their definition (shaders/layout/detail.h), without a hierarchy.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "lodestone/layout/detail.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {

// Where all texels are for rays of that camera, which tolerates errors; `texels`: where they really are.
std::vector<glm::vec3> slid_texels(const ReadyScene& ready, const std::vector<glm::vec3>& texels,
                                   const layout::RayCone& camera);

}  // namespace lodestone::test
