// SPDX-License-Identifier: MIT
// What is seen on mapped charts, whose hits lie between texels of several triangles; on every device.
#include "lodestone/test_support/mapped_charts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "lodestone/geometry_image/atlas_check.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/picture.h"

namespace lodestone::test {
namespace {

class MappedCharts : public testing::TestWithParam<std::string> {
 protected:
  image::Image render(const ReadyScene& ready, uint32_t size) const {
    render::Settings settings;
    settings.width = settings.height = size;
    settings.aovs = {"depth", "normal", "albedo", "uv", "id"};
    return picture(*backend_, ready, 0.4f, settings);
  }
  const std::unique_ptr<render::Backend> backend_ = open(GetParam(), {.validate = GetParam() != "cpu"});
};

double largest_difference(const image::Image& a, const image::Image& b, const std::string& name) {
  const auto &x = a.find(name)->values, &y = b.find(name)->values;
  double largest = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    if (std::isinf(x[i]) && x[i] == y[i]) continue;  // no depth
    largest = std::max(largest, std::abs(double(x[i]) - double(y[i])));
  }
  return largest;
}

// A grid's texels are vertices; between the three of a hit its triangle is linear, as a mapped chart is.
TEST_P(MappedCharts, LookLikeTheGridsWithTheSameTexels) {
  for (const char* name : {"builtin:spheres", "builtin:head"}) {
    ReadyScene ready(name);
    const image::Image grid = render(ready, 64);
    for (const uint32_t nth : {2u, 1u}) {  // some of them, all
      map_grids(ready.atlas, nth);
      ASSERT_EQ(geometry_image::find_fault(ready.atlas), "");
      const image::Image mapped = render(ready, 64);
      EXPECT_EQ(mapped.find("depth.Z")->values, grid.find("depth.Z")->values);
      EXPECT_EQ(mapped.find("A")->values, grid.find("A")->values);
      EXPECT_EQ(mapped.find("id.mesh")->ids, grid.find("id.mesh")->ids);
      for (const char* channel : {"normal.X", "normal.Y", "normal.Z", "albedo.R", "albedo.G", "albedo.B",
                                  "uv.U", "uv.V", "R", "G", "B"})
        EXPECT_LT(largest_difference(mapped, grid, channel), 1e-5) << name << " " << channel;
    }
  }
}

// What must be seen at a point of the mapped square of straddled_squares().
struct Seen {
  glm::dvec2 uv{0};
  glm::dvec4 color{0};
  glm::dvec3 tangent_sum{0};
  double greatest = 0, second = 0;  // weights
  uint32_t triangle = 0;            // of the greatest
};

Seen seen_at(const ReadyScene& ready, glm::dvec2 p) {
  const scene::Mesh& mesh = ready.scene.meshes[0];
  const double across = 0.5 * (p.x + 1) * (straddled_width - 1),
               down = 0.5 * (1 - p.y) * (straddled_height - 1);
  const auto x = static_cast<uint32_t>(across), y = static_cast<uint32_t>(down);
  const double fx = across - x, fy = down - y;
  struct Texel {
    uint32_t x, y;
    double weight;
  };
  const Texel upper[] = {{x, y, 1 - fx - fy}, {x + 1, y, fx}, {x, y + 1, fy}};
  const Texel lower[] = {{x + 1, y + 1, fx + fy - 1}, {x, y + 1, 1 - fx}, {x + 1, y, 1 - fy}};
  Seen seen;
  for (const Texel& texel : fx + fy < 1 ? upper : lower) {
    const glm::dvec2 q = straddled_point(texel.x, texel.y);
    const uint32_t triangle = q.y < q.x ? 1 : 0;
    const double b1 = 0.5 * (triangle == 1 ? 1 + q.y : 1 - q.y),
                 b2 = 0.5 * (triangle == 1 ? 1 - q.x : 1 + q.x);
    const double weights[] = {texel.weight * (1 - b1 - b2), texel.weight * b1, texel.weight * b2};
    for (uint32_t i = 0; i < 3; ++i) {
      seen.uv += weights[i] * glm::dvec2(mesh.texcoords[0][3 * triangle + i]);
      seen.color += weights[i] * glm::dvec4(mesh.colors[3 * triangle + i]);
    }
    seen.tangent_sum += texel.weight * (triangle == 1 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
    if (texel.weight > seen.greatest) {
      seen.second = seen.greatest;
      seen.greatest = texel.weight;
      seen.triangle = triangle;
    } else {
      seen.second = std::max(seen.second, texel.weight);
    }
  }
  seen.color *= glm::dvec4(ready.scene.materials[seen.triangle].base_color);
  return seen;
}

// The normal map's (0.6, 0.2, 1) between a tangent, its bitangent and +Z.
glm::dvec3 bent_normal(const glm::dvec3& along, uint32_t triangle) {
  const glm::dvec3 z(0, 0, 1), tangent = glm::normalize(along);
  const glm::dvec3 bitangent = glm::cross(z, tangent) * (triangle == 1 ? -1.0 : 1.0);
  return glm::normalize(tangent * 0.6 + bitangent * 0.2 + z);
}

// Calls check(x, y, seen) for every pixel on the mapped square but those where rounding decides which texel
// is the nearest.
template <class Check>
void for_each_pixel(const ReadyScene& ready, uint32_t size, const Check& check) {
  uint32_t mixed = 0;
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      const glm::dvec2 p(3 * (x + 0.5) / size - 1.5, 1.5 - 3 * (y + 0.5) / size);
      if (std::abs(p.x) >= 1 || std::abs(p.y) >= 1) continue;
      const Seen seen = seen_at(ready, p);
      if (seen.greatest - seen.second < 1e-4) continue;
      check(x, y, seen);
      if (seen.tangent_sum.x > 0 && seen.tangent_sum.y > 0) ++mixed;
    }
  }
  EXPECT_GT(mixed, size * size / 20) << "hits between texels of both triangles";
}

TEST_P(MappedCharts, AddWhatTheTexelsSeeEachInItsOwnTriangle) {
  constexpr uint32_t size = 70;
  for (const bool tangents : {true, false}) {
    const ReadyScene ready = straddled_squares({.tangents = tangents});
    ASSERT_EQ(geometry_image::find_fault(ready.atlas), "");
    ASSERT_EQ(ready.atlas.kind, geometry_image::AtlasKind::automatic);
    const image::Image image = render(ready, size);
    for_each_pixel(ready, size, [&](uint32_t x, uint32_t y, const Seen& seen) {
      EXPECT_NEAR(value(image, "uv.U", x, y), seen.uv.x, 1e-5) << x << " " << y;
      EXPECT_NEAR(value(image, "uv.V", x, y), seen.uv.y, 1e-5) << x << " " << y;
      EXPECT_NEAR(value(image, "albedo.R", x, y), seen.color.x, 1e-5) << x << " " << y;
      EXPECT_NEAR(value(image, "albedo.G", x, y), seen.color.y, 1e-5) << x << " " << y;
      EXPECT_NEAR(value(image, "albedo.B", x, y), seen.color.z, 1e-5) << x << " " << y;
      EXPECT_EQ(image.find("id.triangle")->ids[size_t(y) * size + x], seen.triangle) << x << " " << y;
      // Those that follow from texture coordinates are one triangle's.
      const glm::dvec3 of_triangle = seen.triangle == 1 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
      const glm::dvec3 normal = bent_normal(tangents ? seen.tangent_sum : of_triangle, seen.triangle);
      EXPECT_NEAR(value(image, "normal.X", x, y), normal.x, 1e-5) << x << " " << y;
      EXPECT_NEAR(value(image, "normal.Y", x, y), normal.y, 1e-5) << x << " " << y;
      EXPECT_NEAR(value(image, "normal.Z", x, y), normal.z, 1e-5) << x << " " << y;
    });
  }
}

TEST_P(MappedCharts, AreCutOutWhereTheSumOfAlphaIsLow) {
  constexpr uint32_t size = 70;
  const ReadyScene ready = straddled_squares({.cut_out = true});
  const image::Image image = render(ready, size);
  uint32_t holes = 0;
  for_each_pixel(ready, size, [&](uint32_t x, uint32_t y, const Seen& seen) {
    if (std::abs(seen.color.w - 0.5) < 1e-4) return;
    EXPECT_EQ(std::isinf(value(image, "depth.Z", x, y)), seen.color.w < 0.5) << x << " " << y;
    if (seen.color.w < 0.5) ++holes;
  });
  EXPECT_GT(holes, 500u);
}

TEST_P(MappedCharts, LeaveTheOthersOfTheAtlasAsTheyWere) {
  constexpr uint32_t size = 70;
  const ReadyScene mixed = straddled_squares(), plain = straddled_squares({.mapped = false});
  const image::Image a = render(mixed, size), b = render(plain, size);
  uint32_t hits = 0;
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      if (std::abs(3 * (x + 0.5) / size - 1.5) < 1) continue;
      const size_t pixel = size_t(y) * size + x;
      for (const image::Channel& channel : a.channels) {
        const image::Channel& other = *b.find(channel.name);
        if (channel.ids.empty()) {
          EXPECT_EQ(std::bit_cast<uint32_t>(channel.values[pixel]),
                    std::bit_cast<uint32_t>(other.values[pixel]))
              << channel.name << " " << x << " " << y;
        } else {
          EXPECT_EQ(channel.ids[pixel], other.ids[pixel]) << channel.name << " " << x << " " << y;
        }
      }
      if (value(a, "A", x, y) > 0) ++hits;
    }
  }
  EXPECT_GT(hits, 500u);
}

INSTANTIATE_TEST_SUITE_P(, MappedCharts, testing::ValuesIn(judged_device_names()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace lodestone::test
