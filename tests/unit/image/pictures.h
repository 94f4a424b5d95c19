// SPDX-License-Identifier: MIT
// Images that several tests start from.
#pragma once

#include <initializer_list>
#include <random>
#include <string>

#include "lodestone/image/image.h"

namespace lodestone::image {

// R G B of one colour, linear.
inline Image plain(uint32_t width, uint32_t height, float r, float g, float b) {
  Image image;
  image.width = width;
  image.height = height;
  image.add("R").values.assign(image.pixels(), r);
  image.add("G").values.assign(image.pixels(), g);
  image.add("B").values.assign(image.pixels(), b);
  return image;
}

// R G B uniform in 0..1, the same for equal seeds.
inline Image noise(uint32_t width, uint32_t height, uint32_t seed) {
  Image image = plain(width, height, 0, 0, 0);
  std::mt19937 random(seed);
  for (Channel& channel : image.channels) {
    for (float& value : channel.values) value = float(random() >> 8) / float(1 << 24);
  }
  return image;
}

inline float& sample(Image& image, const std::string& name, uint32_t x, uint32_t y) {
  for (Channel& channel : image.channels) {
    if (channel.name == name) return channel.values.at(size_t(y) * image.width + x);
  }
  throw std::out_of_range(name);
}

}  // namespace lodestone::image
