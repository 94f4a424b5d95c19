// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lodestone/image/colour_map.h"
#include "lodestone/image/compare.h"
#include "lodestone/image/flip.h"

namespace lodestone::image {
namespace {

constexpr std::array<const char*, 3> colours = {"R", "G", "B"};
constexpr Rgb magenta = {1, 0, 1};
constexpr int largest_magnification = 10;  // as a power of two

Image blank(const Image& like) {
  Image image;
  image.width = like.width;
  image.height = like.height;
  image.linear = false;
  for (const char* name : colours) image.add(name);
  return image;
}

void set_pixel(Image& image, size_t pixel, const Rgb& colour) {
  for (size_t c = 0; c < 3; ++c) image.channels[c].values[pixel] = colour[c];
}

bool has_colour(const Image& image) {
  return std::all_of(colours.begin(), colours.end(), [&](const char* name) {
    const Channel* channel = image.find(name);
    return channel != nullptr && channel->values.size() == image.pixels();
  });
}

// The largest power of two that keeps the largest of `differences` (none NaN) within 1.
int magnification(const std::vector<float>& differences) {
  float largest = 0;
  for (const float difference : differences) {
    if (std::isfinite(difference)) largest = std::max(largest, difference);
  }
  if (largest == 0) return 1;
  return 1 << std::clamp(int(std::floor(-std::log2(largest))), 0, largest_magnification);
}

// |a - b|; infinite where one is non-finite and the other not the same.
float distance(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  if (!std::isfinite(a) || !std::isfinite(b)) return std::numeric_limits<float>::infinity();
  return std::abs(a - b);
}

// Per channel R G B, one array behind the other.
std::vector<float> colour_distances(const Image& a, const Image& b) {
  const Image shown_a = for_display(a), shown_b = for_display(b);
  std::vector<float> distances;
  distances.reserve(colours.size() * a.pixels());
  for (const char* name : colours) {
    const std::vector<float>&raw_a = a.find(name)->values, &raw_b = b.find(name)->values;
    const std::vector<float>&encoded_a = shown_a.find(name)->values, &encoded_b = shown_b.find(name)->values;
    for (size_t i = 0; i < raw_a.size(); ++i) {
      const float raw = distance(raw_a[i], raw_b[i]);
      distances.push_back(std::isfinite(raw) ? std::abs(encoded_a[i] - encoded_b[i]) : raw);
    }
  }
  return distances;
}

Image colour_difference(const Image& a, const std::vector<float>& distances, int factor) {
  Image image = blank(a);
  const size_t pixels = a.pixels();
  for (size_t i = 0; i < pixels; ++i) {
    const Rgb colour = {distances[i], distances[pixels + i], distances[2 * pixels + i]};
    const bool finite = std::isfinite(colour[0]) && std::isfinite(colour[1]) && std::isfinite(colour[2]);
    set_pixel(image, i,
              finite ? Rgb{float(factor) * colour[0], float(factor) * colour[1], float(factor) * colour[2]}
                     : magenta);
  }
  return image;
}

// Over all channels that both images have; ids are 0 or 1 apart.
std::vector<float> largest_distances(const Image& a, const Image& b) {
  std::vector<float> largest(a.pixels());
  for (const Channel& channel : a.channels) {
    const Channel* other = b.find(channel.name);
    if (other == nullptr || other->ids.size() != channel.ids.size()) continue;
    for (size_t i = 0; i < largest.size(); ++i) {
      const float apart = channel.ids.empty() ? distance(channel.values[i], other->values[i])
                                              : float(channel.ids[i] != other->ids[i] ? 1 : 0);
      largest[i] = std::max(largest[i], apart);
    }
  }
  return largest;
}

template <class Map>
Image mapped(const Image& like, const std::vector<float>& values, Map map) {
  Image image = blank(like);
  for (size_t i = 0; i < values.size(); ++i)
    set_pixel(image, i, std::isfinite(values[i]) ? map(std::min(values[i], 1.0f)) : magenta);
  return image;
}

}  // namespace

Image difference_image(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.pixels() == 0)
    throw std::invalid_argument("a difference of images of different sizes");
  if (has_colour(a) && has_colour(b)) {
    const std::vector<float> distances = colour_distances(a, b);
    const int factor = magnification(distances);
    return contact_sheet({colour_difference(a, distances, factor), mapped(a, flip_error(a, b), heat)},
                         {fmt::format("|A-B| x{}", factor), "FLIP"}, 2);
  }
  std::vector<float> distances = largest_distances(a, b);
  const int factor = magnification(distances);
  for (float& distance : distances) distance *= float(factor);
  const auto grey = [](float value) { return Rgb{value, value, value}; };
  const std::string label = fmt::format("max |A-B| x{}", factor);
  return contact_sheet({mapped(a, distances, grey), mapped(a, distances, heat)}, {label, label}, 2);
}

}  // namespace lodestone::image
