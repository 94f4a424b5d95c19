// SPDX-License-Identifier: MIT
#include "lodestone/render/focus.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "lodestone/layout/atlas.h"

namespace lodestone::render {
namespace {

constexpr int half_side = 8;  // of the grid, which fills the picture up to half a step from its edge
constexpr int half_middle = 2;
constexpr size_t middle_rays = size_t(2 * half_middle + 1) * (2 * half_middle + 1);
constexpr float far_away = 1e6f;

float along_view(const View& view, const glm::vec4& direction, const glm::uvec4& hit) {
  return std::bit_cast<float>(hit.x) * glm::dot(glm::vec3(direction), glm::normalize(view.forward));
}

}  // namespace

std::vector<glm::vec4> focus_rays(const View& view) {
  std::vector<glm::ivec2> points;
  for (int y = -half_side; y <= half_side; ++y) {
    for (int x = -half_side; x <= half_side; ++x) points.emplace_back(x, y);
  }
  const auto is_middle = [](const glm::ivec2& p) {
    return std::abs(p.x) <= half_middle && std::abs(p.y) <= half_middle;
  };
  std::stable_partition(points.begin(), points.end(), is_middle);
  std::vector<glm::vec4> rays;
  for (const glm::ivec2& point : points) {
    const glm::vec2 at = glm::vec2(point) / (float(half_side) + 0.5f);
    const glm::vec3 offset = view.right * at.x + view.up * at.y;
    const glm::vec3 origin = view.perspective ? view.origin : view.origin + offset;
    const glm::vec3 direction = glm::normalize(view.perspective ? view.forward + offset : view.forward);
    rays.emplace_back(origin, 0.0f);
    rays.emplace_back(direction, 1e30f);
  }
  return rays;
}

float focus_of(const View& view, const std::vector<glm::vec4>& rays, const std::vector<glm::uvec4>& hits) {
  float nearest = far_away;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (i == middle_rays && nearest < far_away) break;
    if (hits[i].w != layout::no_index)
      nearest = std::min(nearest, along_view(view, rays[2 * i + 1], hits[i]));
  }
  return nearest;
}

}  // namespace lodestone::render
