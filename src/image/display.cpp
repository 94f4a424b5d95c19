// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/image/colour.h"
#include "lodestone/image/image.h"

namespace lodestone::image {
namespace {

// Finite samples stretched to 0..1; the others to 0 and 1.
std::vector<float> stretched(const Channel& channel) {
  std::vector<float> samples = channel.values;
  if (!channel.ids.empty()) samples.assign(channel.ids.begin(), channel.ids.end());
  float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
  for (const float sample : samples) {
    if (!std::isfinite(sample)) continue;
    lowest = std::min(lowest, sample);
    highest = std::max(highest, sample);
  }
  // Halved first: the difference of two large samples may overflow.
  const float range = highest / 2 - lowest / 2;
  for (float& sample : samples) {
    if (std::isfinite(sample)) sample = range > 0 ? (sample / 2 - lowest / 2) / range : 0.0f;
    sample = clamp_unit(sample);
  }
  return samples;
}

}  // namespace

Image for_display(const Image& image) {
  Image display;
  display.width = image.width;
  display.height = image.height;
  display.linear = false;
  const bool coloured =
      image.find("R") != nullptr && image.find("G") != nullptr && image.find("B") != nullptr;
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float>& values = display.add(name).values;
    if (!coloured || image.find(name)->values.empty()) {
      if (!image.channels.empty()) values = stretched(coloured ? *image.find(name) : image.channels.front());
      continue;
    }
    const std::vector<float>& source = image.find(name)->values;
    std::transform(source.begin(), source.end(), values.begin(), [&](float value) {
      const float clamped = clamp_unit(value);
      return image.linear ? srgb_encode(clamped) : clamped;
    });
  }
  return display;
}

}  // namespace lodestone::image
