// SPDX-License-Identifier: MIT
// Which triangles of a surface shine, and by what power they are drawn as lights (layout/emitters.h).
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::render {

struct EmitterData {
  // Of each chart ChartRecord::first_emitter. Empty: nothing shines.
  std::vector<uint32_t> first_of_charts;
  std::vector<uint32_t> texels;   // of the atlas, one an emitter
  std::vector<uint32_t> numbers;  // the first number of each half, two an emitter
  // Of each object, in its own space, in the rest pose: its halves, and their power, area times the mean
  // luminance of what they emit.
  struct Object {
    uint32_t first_half = 0, end_half = 0;
    double power = 0;
  };
  std::vector<Object> objects;

  bool empty() const { return first_of_charts.empty(); }
};

// The same for any number of threads.
EmitterData make_emitters(const scene::Scene& scene, const scene::Assembly& assembly,
                          const geometry_image::Atlas& atlas);

}  // namespace lodestone::render
