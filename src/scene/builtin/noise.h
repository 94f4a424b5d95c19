// SPDX-License-Identifier: MIT
// Value noise over the plane. Integers and + - * / only: the same bits everywhere.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace lodestone::scene::builtin {

// A number in [0, 1) that looks random, of a lattice point.
inline float lattice_noise(int x, int y, uint32_t octave) {
  uint32_t h = uint32_t(x) * 0x8da6b343u ^ uint32_t(y) * 0xd8163841u ^ (octave + 1) * 0xcb1ab31fu;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return float((h ^ (h >> 15)) >> 8) / 16777216.0f;
}

// Value noise: the noise of the four lattice points around, smoothly blended.
inline float value_noise(float x, float y, uint32_t octave) {
  const int ix = int(std::floor(x)), iy = int(std::floor(y));
  const float fx = x - float(ix), fy = y - float(iy);
  const float sx = fx * fx * (3 - 2 * fx), sy = fy * fy * (3 - 2 * fy);
  const float low = glm::mix(lattice_noise(ix, iy, octave), lattice_noise(ix + 1, iy, octave), sx);
  const float high = glm::mix(lattice_noise(ix, iy + 1, octave), lattice_noise(ix + 1, iy + 1, octave), sx);
  return glm::mix(low, high, sy);
}

// Octaves of value noise around 0, each half as strong and 2.1 times as fine as the one before: the first
// from -1 to 1, its lattice 1 / frequency wide.
inline float fractal_noise(glm::vec2 p, float frequency, uint32_t octaves) {
  float sum = 0, amplitude = 1;
  for (uint32_t octave = 0; octave < octaves; ++octave) {
    sum += amplitude * (2 * value_noise(p.x * frequency, p.y * frequency, octave) - 1);
    amplitude *= 0.5f;
    frequency *= 2.1f;
  }
  return sum;
}

}  // namespace lodestone::scene::builtin
