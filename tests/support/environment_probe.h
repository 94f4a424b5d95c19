// SPDX-License-Identifier: MIT
// The functions of layout/environment.h, one direction at a time, over what make_environment has made.
#pragma once

#include <vector>

#include "lodestone/layout/shading.h"
#include "lodestone/render/environment_tables.h"
#include "lodestone/render/view.h"

namespace lodestone::test {
namespace environment_functions {

using namespace layout;

inline glm::vec3 as_vec3(const glm::uvec4& bits) {
  return {uintBitsToFloat(bits.x), uintBitsToFloat(bits.y), uintBitsToFloat(bits.z)};
}

class Probe {
 public:
  explicit Probe(const scene::Scene& scene) : Probe(render::make_environment(scene)) {
    const scene::Sky sky = render::frame_sky(scene);
    frames[0].sky_top = sky.top;
    frames[0].sky_horizon = sky.horizon;
    frames[0].sky_bottom = sky.bottom;
  }

#define LOAD4(result, buffer, i) result = buffer.at(i)
#define LOAD1(result, buffer, i) result = buffer.at(i)
#include "lodestone/layout/environment.h"
#undef LOAD4
#undef LOAD1

  FrameRecord frames[1] = {};
  std::vector<glm::uvec4> environment_quads;
  std::vector<uint32_t> environment_cells;
  uint32_t environment_map;

 private:
  explicit Probe(const render::EnvironmentData& data)
      : environment_quads(data.quads), environment_cells(data.cells), environment_map(data.map ? 1 : 0) {
    frames[0].environment = data.record;
  }
};

}  // namespace environment_functions

using EnvironmentProbe = environment_functions::Probe;

}  // namespace lodestone::test
