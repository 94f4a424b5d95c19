// SPDX-License-Identifier: MIT
#include "lodestone/test_support/secondary_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "lodestone/geometry_image/texel_values.h"
#include "lodestone/layout/atlas.h"

namespace lodestone::test {
namespace {

using glm::uvec3, glm::vec2, glm::vec3;

constexpr float turn = 6.2831853f;

vec2 disc_point(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0, 1);
  const float radius = std::sqrt(unit(random)), angle = turn * unit(random);
  return radius * vec2(std::cos(angle), std::sin(angle));
}

// A microfacet's normal round `normal`, by GGX's distribution of normals.
vec3 microfacet(const vec3& normal, float alpha, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0, 1);
  const float share = unit(random), angle = turn * unit(random);
  const float cosine = std::sqrt((1 - share) / (1 + (alpha * alpha - 1) * share));
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  const vec3 aside = std::abs(normal.x) < 0.8f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  const vec3 across = glm::normalize(glm::cross(normal, aside)), up = glm::cross(normal, across);
  return sine * (std::cos(angle) * across + std::sin(angle) * up) + cosine * normal;
}

// The corners of each primitive that a hit can name.
std::vector<uvec3> corners_by_primitive(const ReadyScene& ready) {
  const QuadTriangles quads = quad_triangles(ready.atlas);
  std::vector<uvec3> corners(2 * ready.atlas.texel_map.size());
  for (size_t i = 0; i < quads.texels.size(); ++i) corners[quads.primitives[i]] = quads.texels[i];
  return corners;
}

}  // namespace

Rays lens_rays(const render::View& view, uint32_t size, float focus, float radius, uint32_t seed) {
  if (!view.perspective) throw std::invalid_argument("a lens needs a perspective view");
  std::mt19937 random(seed);
  const vec3 right = glm::normalize(view.right), up = glm::normalize(view.up);
  const Rays pinhole = primary_rays(view, size);
  Rays rays;
  for (size_t i = 0; i < pinhole.size(); i += 2) {
    const vec3 direction(pinhole[i + 1]);
    const vec3 sharp = view.origin + direction * (focus / glm::dot(direction, glm::normalize(view.forward)));
    const vec2 lens = radius * disc_point(random);
    const vec3 origin = view.origin + right * lens.x + up * lens.y;
    add_ray(rays, origin, sharp - origin);
  }
  return rays;
}

Rays glossy_rays(const Rays& rays, const std::vector<glm::uvec4>& hits, const ReadyScene& ready,
                 const scene::Pose& pose, float roughness, uint32_t seed) {
  const std::vector<vec3> points = ready.texels(pose);
  const std::vector<vec3> normals = geometry_image::at_texels(
      ready.assembly, ready.atlas.texel_map,
      scene::blended_normals(ready.assembly, scene::frame_weights(ready.scene, ready.assembly, pose),
                             scene::frame_matrices(ready.scene, ready.assembly, pose)));
  const std::vector<uvec3> corners = corners_by_primitive(ready);
  const scene::Bounds bounds = scene::pose_bounds(ready.scene, pose);
  const float clearance = 1e-4f * glm::length(bounds.hi - bounds.lo);
  std::mt19937 random(seed);
  Rays result;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].w == layout::no_index) continue;
    const uvec3 at = corners[hits[i].w];
    const float u = std::bit_cast<float>(hits[i].y), v = std::bit_cast<float>(hits[i].z);
    const vec3 on = points[at.x] * (1 - u - v) + points[at.y] * u + points[at.z] * v;
    const vec3 normal = glm::normalize(normals[at.x] * (1 - u - v) + normals[at.y] * u + normals[at.z] * v);
    const vec3 facing = glm::cross(points[at.y] - points[at.x], points[at.z] - points[at.x]);
    const vec3 along(rays[2 * i + 1]);
    const vec3 direction = glm::reflect(along, microfacet(normal, roughness * roughness, random));
    if (!(glm::dot(along, facing) < 0 && glm::dot(direction, facing) > 0)) continue;
    add_ray(result, on + glm::normalize(facing) * clearance, direction);
  }
  return result;
}

}  // namespace lodestone::test
