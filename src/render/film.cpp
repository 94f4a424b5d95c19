// SPDX-License-Identifier: MIT
#include "lodestone/render/film.h"

#include <algorithm>
#include <bit>
#include <map>

#include "lodestone/base/error.h"

namespace lodestone::render {
namespace {

// Where a channel stands among a pixel's 16 words.
struct Place {
  const char* channel;
  uint32_t word;
  bool id;
};

const std::map<std::string, std::vector<Place>>& places() {
  static const std::map<std::string, std::vector<Place>> all = {
      {"depth", {{"depth.Z", 0, false}}},
      {"normal", {{"normal.X", 1, false}, {"normal.Y", 2, false}, {"normal.Z", 3, false}}},
      {"albedo", {{"albedo.R", 4, false}, {"albedo.G", 5, false}, {"albedo.B", 6, false}}},
      {"uv", {{"uv.U", 8, false}, {"uv.V", 9, false}}},
      {"id", {{"id.mesh", 10, true}, {"id.triangle", 11, true}}},
      {"lod", {{"lod.L", 12, false}}},
      {"steps", {{"steps.N", 13, true}}},
  };
  return all;
}

}  // namespace

void check_aovs(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (!places().contains(name)) {
      fail(ExitCode::usage, "--aov " + name,
           "no such output; there are: depth, normal, albedo, uv, id, lod, steps");
    }
  }
}

image::Image make_color_image(const Settings& settings, const std::vector<glm::vec4>& pixels, bool alpha) {
  image::Image image;
  image.width = settings.width;
  image.height = settings.height;
  const char* names[] = {"R", "G", "B", "A"};
  for (int c = 0; c < (alpha ? 4 : 3); ++c) {
    image::Channel& channel = image.add(names[c]);
    for (size_t i = 0; i < pixels.size(); ++i) channel.values[i] = pixels[i][c];
  }
  return image;
}

void add_noisy(const std::vector<glm::vec4>& pixels, image::Image& image) {
  const char* names[] = {"noisy.R", "noisy.G", "noisy.B"};
  for (int c = 0; c < 3; ++c) {
    image::Channel& channel = image.add(names[c]);
    for (size_t i = 0; i < pixels.size(); ++i) channel.values[i] = pixels[i][c];
  }
}

void add_aovs(const Settings& settings, const std::vector<glm::uvec4>& quads, image::Image& image) {
  const auto* words = reinterpret_cast<const uint32_t*>(quads.data());
  const size_t pixels = size_t(settings.width) * settings.height;
  for (const std::string& name : settings.aovs) {
    for (const Place& place : places().at(name)) {
      const auto value = [&](size_t pixel) { return words[16 * pixel + place.word]; };
      if (place.id && name == "id") {
        image::Channel& channel = image.add_ids(place.channel);
        for (size_t i = 0; i < pixels; ++i) channel.ids[i] = value(i);
      } else {
        image::Channel& channel = image.add(place.channel);
        for (size_t i = 0; i < pixels; ++i) {
          channel.values[i] = place.id ? static_cast<float>(value(i)) : std::bit_cast<float>(value(i));
        }
      }
    }
  }
}

}  // namespace lodestone::render
