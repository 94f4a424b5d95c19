// SPDX-License-Identifier: MIT
// Freckles: too small for the vertices of the skin, so a picture.
#include <algorithm>
#include <cmath>

#include "lodestone/scene/builtin/head_parts.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;
constexpr uint32_t size = 512;
constexpr float front = 1.2f;  // azimuth that the picture reaches on either side; beyond it is mirrored

// A number in [0, 1) that looks random.
float hashed(uint32_t k) {
  k = (k ^ (k >> 16)) * 0x7feb352du;
  k = (k ^ (k >> 15)) * 0x846ca68bu;
  return float((k ^ (k >> 16)) >> 8) / 16777216.0f;
}

struct Freckle {
  glm::vec2 centre;  // pixels
  float radius, depth;
};

std::vector<Freckle> freckles() {
  std::vector<Freckle> all;
  for (uint32_t k = 0; k < 2000; k += 5) {
    const Aim aim{glm::mix(-0.80f, 0.80f, hashed(k)), glm::mix(-0.36f, 0.06f, hashed(k + 1))};
    // Densest on the cheeks beside the nose, some across it.
    const Aim half{std::abs(aim.azimuth), aim.elevation};
    const float dense =
        std::max(bump(half, {0.42f, -0.17f}, {0.36f, 0.17f}), 0.8f * bump(half, {0, -0.07f}, {0.2f, 0.13f}));
    if (hashed(k + 2) > 1.2f * dense) continue;
    const Freckle freckle{freckle_coordinates(aim) * float(size), 2.2f + 2.6f * hashed(k + 3) * hashed(k + 4),
                          0.30f + 0.45f * hashed(k + 4)};
    const bool apart = std::all_of(all.begin(), all.end(), [&](const Freckle& other) {
      return glm::length(other.centre - freckle.centre) > 1.7f * (other.radius + freckle.radius);
    });
    if (apart) all.push_back(freckle);
  }
  return all;
}

}  // namespace

glm::vec2 freckle_coordinates(Aim aim) {
  const float a = std::abs(aim.azimuth);
  const float across = a < front ? a / front : (pi - a) / (pi - front);
  return {0.5f + std::copysign(0.48f * across, aim.azimuth), 0.5f - aim.elevation / pi};
}

Image freckle_image() {
  Image image;
  image.name = "freckles";
  image.width = image.height = size;
  image.rgba.assign(size_t(size) * size * 4, 255);
  const glm::vec3 tint(0.20f, 0.42f, 0.50f);  // what a freckle takes away, as stored
  for (const Freckle& freckle : freckles()) {
    const glm::ivec2 lo = glm::ivec2(freckle.centre - freckle.radius),
                     hi = glm::ivec2(freckle.centre + freckle.radius);
    for (int y = lo.y; y <= hi.y; ++y)
      for (int x = lo.x; x <= hi.x; ++x) {
        const glm::vec2 offset = glm::vec2(x, y) + 0.5f - freckle.centre;
        const float dark = freckle.depth * bump(glm::length(offset) / freckle.radius);
        uint8_t* texel = &image.rgba[(size_t(y) * size + size_t(x)) * 4];
        for (int c = 0; c < 3; ++c) texel[c] = uint8_t(float(texel[c]) * (1 - dark * tint[c]) + 0.5f);
      }
  }
  return image;
}

}  // namespace lodestone::scene::builtin
