// SPDX-License-Identifier: MIT
#include "lodestone/app/atlas_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/memory.h"
#include "lodestone/geometry_image/atlas_picture.h"
#include "lodestone/image/colour.h"
#include "lodestone/image/colour_map.h"
#include "lodestone/image/colour_scale.h"
#include "lodestone/image/image.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/scene/pose.h"

namespace lodestone::app {
namespace {

using geometry_image::AtlasPicture;
using geometry_image::AtlasSurface;

constexpr std::array<const char*, 4> names = {"positions", "normals", "charts", "stretch"};
constexpr std::array<const char*, 3> rgb = {"R", "G", "B"};
constexpr uint32_t large_enough = 1024;     // pixels of the longer side
constexpr float between_charts = 0.3f;      // no colour of heat()
constexpr float least = 0.5f, most = 3.0f;  // stretch

image::Image blank(const AtlasPicture& picture, uint32_t grown) {
  image::Image drawn;
  drawn.width = picture.width * grown;
  drawn.height = picture.height * grown;
  return drawn;
}

// `colours`: encoded ones, of texels.
image::Image draw(const AtlasPicture& picture, const std::vector<glm::vec3>& colours) {
  const uint32_t longer = std::max(picture.width, picture.height);
  const uint32_t grown = (large_enough + longer - 1) / longer;
  image::Image drawn = blank(picture, grown);
  drawn.linear = false;
  for (int c = 0; c < 3; ++c) {
    float* pixel = drawn.add(rgb[size_t(c)]).values.data();
    for (uint32_t y = 0; y < drawn.height; ++y) {
      const uint32_t* texels = &picture.texels[uint64_t(y / grown) * picture.width];
      for (uint32_t x = 0; x < drawn.width; ++x) {
        const uint32_t texel = texels[x / grown];
        *pixel++ = texel == layout::no_index ? between_charts : colours[texel][c];
      }
    }
  }
  return drawn;
}

// A channel that is value(texel) on charts and 0 between them.
template <class T, class Value>
void fill(const AtlasPicture& picture, std::vector<T>& channel, Value value) {
  std::transform(picture.texels.begin(), picture.texels.end(), channel.begin(),
                 [&](uint32_t texel) { return texel == layout::no_index ? T(0) : T(value(texel)); });
}

void add_vectors(const AtlasPicture& picture, const std::vector<glm::vec3>& vectors, image::Image& drawn) {
  for (int c = 0; c < 3; ++c) {
    fill(picture, drawn.add(rgb[size_t(c)]).values, [&](uint32_t texel) { return vectors[texel][c]; });
  }
}

// What the colours of a .png stand for, with the share of each pixel that is on a chart: 1 or 0.
image::Image numbers(const std::string& what, const geometry_image::Atlas& atlas, const AtlasPicture& picture,
                     const AtlasSurface& surface) {
  image::Image drawn = blank(picture, 1);
  if (what == "positions") add_vectors(picture, surface.positions, drawn);
  if (what == "normals") add_vectors(picture, surface.normals, drawn);
  if (what == "charts") {
    std::vector<glm::vec3> colours = geometry_image::chart_colours(atlas, surface);
    for (glm::vec3& colour : colours) {
      for (int c = 0; c < 3; ++c) colour[c] = image::srgb_decode(colour[c]);
    }
    add_vectors(picture, colours, drawn);
    fill(picture, drawn.add_ids("id.chart").ids,
         [&](uint32_t texel) { return atlas.texel_map[texel].w; });  // from 1
  }
  if (what == "stretch")
    fill(picture, drawn.add("Y").values, [&](uint32_t texel) { return surface.stretch[texel]; });
  fill(picture, drawn.add("A").values, [](uint32_t) { return 1.0f; });
  return drawn;
}

float place_of(float stretch) {
  return std::log(std::max(stretch, least) / least) / std::log(most / least);
}

image::Image draw_stretch(const AtlasPicture& picture, const AtlasSurface& surface) {
  std::vector<glm::vec3> colours;
  colours.reserve(surface.stretch.size());
  for (const float stretch : surface.stretch) {
    const image::Rgb colour = image::heat(place_of(stretch));
    colours.emplace_back(colour[0], colour[1], colour[2]);
  }
  std::vector<image::Mark> marks;
  for (const float stretch : {0.5f, 0.7f, 1.0f, 1.4f, 2.0f, 3.0f})
    marks.push_back({place_of(stretch), fmt::format("{}", stretch)});
  return image::with_colour_scale(draw(picture, colours), "L2 stretch; 1: the mean density of texels", marks);
}

image::Image picture_of(const std::string& what, const geometry_image::Atlas& atlas,
                        const AtlasPicture& picture, const AtlasSurface& surface) {
  if (what == "positions") return draw(picture, geometry_image::position_colours(atlas, surface));
  if (what == "normals") return draw(picture, geometry_image::normal_colours(surface));
  if (what == "charts") return draw(picture, geometry_image::chart_colours(atlas, surface));
  return draw_stretch(picture, surface);
}

}  // namespace

AtlasImageFiles::AtlasImageFiles(const std::string& name) : name_(name) {
  if (!name.empty()) OutputPattern("--atlas-image", name);  // for its extension
}

std::filesystem::path AtlasImageFiles::path(const char* what) const {
  std::filesystem::path file = name_;
  return file.replace_filename(
      fmt::format("{}-{}{}", name_.stem().string(), what, name_.extension().string()));
}

void AtlasImageFiles::check(const std::string& scene) const {
  if (empty()) return;
  for (const char* what : names) {
    check_distinct({{"--atlas-image", path(what)}}, {{"the scene", scene}});
    check_writable(path(what));
  }
}

std::string AtlasImageFiles::write(const scene::Scene& scene, const scene::Assembly& assembly,
                                   const geometry_image::Atlas& atlas) const {
  // The surface, colours of texels, the picture and the file it becomes.
  constexpr uint64_t bytes_a_pixel = sizeof(uint32_t) + 7 * sizeof(float) + 2 * sizeof(glm::vec3) + 12;
  const AtlasPicture picture = geometry_image::lay_out(atlas, name_.string());
  require_memory(picture.texels.size() * bytes_a_pixel, name_.string());
  const AtlasSurface surface =
      geometry_image::surface_of(scene, assembly, atlas, scene::evaluate(scene, scene::none, 0));
  const bool exr = lower_extension(name_) == ".exr";
  for (const char* what : names) {
    image::write(path(what),
                 exr ? numbers(what, atlas, picture, surface) : picture_of(what, atlas, picture, surface));
  }
  constexpr double percent = 100;
  return fmt::format("  pictures         {} x {} texels, {:.1f} % of them in charts\n", picture.width,
                     picture.height, percent * picture.filled);
}

}  // namespace lodestone::app
