// SPDX-License-Identifier: MIT
// The environment on the device: radiance, and how directions are chosen by it (layout/environment.h).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/layout/frame.h"
#include "lodestone/render/backend.h"
#include "lodestone/scene/scene.h"

namespace lodestone::render {

// What the buffers hold.
struct EnvironmentData {
  layout::EnvironmentRecord record{};
  std::vector<glm::uvec4> quads;
  std::vector<uint32_t> cells;
  double light = 0;  // luminance summed up over all directions
  bool map = false;  // else the analytic sky, of which there are no texels
};

// Of the scene's map, else of its sky (`frame_sky`). All in doubles, the same for any number of threads.
// Radiance nearer to zero than 2^-60 becomes zero. Where all is black, all directions are equally likely.
EnvironmentData make_environment(const scene::Scene& scene);

// Uploaded once.
struct EnvironmentTables {
  EnvironmentTables(Backend& backend, const scene::Scene& scene);

  layout::EnvironmentRecord record;
  Buffer quads, cells;
  double light = 0;  // EnvironmentData
  uint32_t map = 0;  // `environment_map` of layout/environment.h
};

}  // namespace lodestone::render
