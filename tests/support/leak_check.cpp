// SPDX-License-Identifier: MIT
#include "lodestone/test_support/leak_check.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>

#include "lodestone/base/parallel.h"
#include "lodestone/test_support/rays.h"

namespace lodestone::test {
namespace {

using glm::dvec3;
using glm::vec3;

double winding_number(const vec3& point, const std::vector<vec3>& texels, const QuadTriangles& quads) {
  double sum = 0;
  for (const glm::uvec3& t : quads.texels) {
    const dvec3 a = dvec3(texels[t.x]) - dvec3(point), b = dvec3(texels[t.y]) - dvec3(point),
                c = dvec3(texels[t.z]) - dvec3(point);
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double volume = glm::dot(a, glm::cross(b, c));
    const double base = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    sum += 2 * std::atan2(volume, base);
  }
  return sum / (4 * 3.14159265358979);
}

vec3 aim(std::mt19937& random, const std::vector<vec3>& texels, const QuadTriangles& quads, uint64_t kind,
         const vec3& origin) {
  std::uniform_int_distribution<size_t> pick(0, quads.texels.size() - 1);
  std::uniform_int_distribution<int> corner(0, 2);
  std::uniform_real_distribution<float> unit(0, 1);
  const glm::uvec3 t = quads.texels[pick(random)];
  const int i = corner(random);
  if (kind % 3 == 0) return texels[t[i]] - origin;
  if (kind % 3 == 1) {
    const float s = unit(random);
    return texels[t[i]] * (1 - s) + texels[t[(i + 1) % 3]] * s - origin;
  }
  return random_direction(random);
}

}  // namespace

std::vector<vec3> points_inside(const std::vector<vec3>& texels, const QuadTriangles& quads, uint32_t count,
                                uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::uniform_int_distribution<size_t> pick(0, quads.texels.size() - 1);
  // Between two points of the surface: what is closed has plenty of those inside, however little room it
  // takes in the bounds of all.
  const auto on_surface = [&] {
    const glm::uvec3 t = quads.texels[pick(random)];
    return (texels[t.x] + texels[t.y] + texels[t.z]) / 3.0f;
  };
  const auto between = [&] {
    const vec3 a = on_surface(), b = on_surface();
    return a + (b - a) * unit(random);
  };
  std::vector<vec3> inside;
  for (uint32_t tries = 0; inside.size() < count && tries < 60; ++tries) {
    std::vector<vec3> points(2 * count);
    std::generate(points.begin(), points.end(), between);
    std::vector<double> turns(points.size());
    parallel_for(points.size(), 1, [&](uint64_t begin, uint64_t end) {
      for (uint64_t i = begin; i < end; ++i) turns[i] = winding_number(points[i], texels, quads);
    });
    for (size_t i = 0; i < points.size() && inside.size() < count; ++i) {
      if (std::abs(turns[i]) > 0.99) inside.push_back(points[i]);
    }
  }
  return inside;
}

LeakReport check_leaks(render::Renderer& renderer, const std::vector<vec3>& texels,
                       const QuadTriangles& quads, const std::vector<vec3>& origins, uint64_t count,
                       uint32_t seed) {
  LeakReport report;
  report.origins = static_cast<uint32_t>(origins.size());
  constexpr uint64_t batch = 1u << 20;
  for (uint64_t first = 0; first < count; first += batch) {
    const uint64_t rays_now = std::min(batch, count - first);
    Rays rays(2 * rays_now);
    parallel_for(rays_now, 4096, [&](uint64_t begin, uint64_t end) {
      std::mt19937 random(static_cast<uint32_t>(seed + 977 * ((first + begin) / 4096)));
      Rays some;
      for (uint64_t i = begin; i < end; ++i) {
        const vec3 origin = origins[(first + i) % origins.size()];
        some.clear();
        add_ray(some, origin, aim(random, texels, quads, (first + i) / origins.size(), origin));
        rays[2 * i] = some[0];
        rays[2 * i + 1] = some[1];
      }
    });
    renderer.load_rays(rays);
    renderer.trace_loaded();
    const auto hits = renderer.hits();
    for (uint64_t i = 0; i < rays_now; ++i) {
      if (hits[i].w != layout::no_index) continue;
      if (report.leaks++ == 0) {
        report.origin = vec3(rays[2 * i]);
        report.direction = vec3(rays[2 * i + 1]);
      }
    }
    report.rays += rays_now;
  }
  return report;
}

}  // namespace lodestone::test
