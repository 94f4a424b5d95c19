// SPDX-License-Identifier: MIT
// Sand, wet where the sea reaches it and rippled by the wind, and meadows: finer than the vertices of the
// ground.
#include <algorithm>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/scene/builtin/island.h"
#include "lodestone/scene/builtin/noise.h"
#include "lodestone/scene/builtin/texel.h"

namespace lodestone::scene::builtin {
namespace {

constexpr uint32_t size = 512;
constexpr float texel_width = 2 * ground_half_width / size;

// The steepness, rise by run.
float slope_at(glm::vec2 place) {
  const float here = island_height(place);
  return glm::length(glm::vec2(island_height(place + glm::vec2(1, 0)) - here,
                               island_height(place + glm::vec2(0, 1)) - here));
}

glm::vec3 sand_color(glm::vec2 place, float above_sea) {
  const glm::vec3 wet(0.27f, 0.20f, 0.12f), dry(0.66f, 0.53f, 0.33f);
  const float line = above_sea + 0.25f * fractal_noise(place, 0.15f, 2);
  const float bend = 2.5f * fractal_noise(place, 0.09f, 2);
  const float ripples = std::sin(2.6f * place.x + 1.3f * place.y + 2 * bend) *
                        std::max(fractal_noise(place, 0.05f, 1) + 0.3f, 0.0f);
  const float grain = fractal_noise(place, 1.1f, 2);
  return glm::mix(wet, dry, glm::smoothstep(0.15f, 0.9f, line)) * (1 + 0.04f * ripples + 0.05f * grain);
}

glm::vec3 grass_color(glm::vec2 place) {
  const glm::vec3 lush(0.075f, 0.17f, 0.03f), withered(0.24f, 0.25f, 0.075f);
  const float tufts = fractal_noise(place, 0.9f, 2);
  return glm::mix(lush, withered, glm::smoothstep(-0.6f, 0.9f, fractal_noise(place, 0.08f, 3))) *
         (1 + 0.35f * tufts);
}

glm::vec3 ground_color(glm::vec2 place) {
  const float above_sea = island_height(place) - sea_level;
  // Meadows lie higher than the beach, not on slopes and not around the teapots; their borders are ragged.
  const float grown = fractal_noise(place, 0.045f, 3) + 0.3f * fractal_noise(place + 40.0f, 0.5f, 3);
  const float meadow = glm::smoothstep(2.0f, 3.0f, above_sea + 0.5f * grown) *
                       glm::smoothstep(-0.2f, 0.05f, grown - 0.5f * slope_at(place)) *
                       glm::smoothstep(plateau_radius, 1.6f * plateau_radius, glm::length(place) + 3 * grown);
  return glm::mix(sand_color(place, above_sea), grass_color(place), meadow);
}

}  // namespace

Image island_picture() {
  Image image;
  image.name = "island";
  image.width = image.height = size;
  image.rgba.assign(size_t(size) * size * 4, 255);
  parallel_for(size, 16, [&](uint64_t first, uint64_t last) {
    for (uint64_t y = first; y < last; ++y)
      for (uint64_t x = 0; x < size; ++x) {
        const glm::vec2 place = (glm::vec2(x, y) + 0.5f) * texel_width - ground_half_width;
        const glm::vec3 color = ground_color(place);
        for (int c = 0; c < 3; ++c) image.rgba[(y * size + x) * 4 + size_t(c)] = color_texel(color[c]);
      }
  });
  return image;
}

}  // namespace lodestone::scene::builtin
