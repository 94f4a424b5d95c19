// SPDX-License-Identifier: MIT
#include "lodestone/render/focus.h"

#include <algorithm>
#include <bit>

#include "lodestone/layout/atlas.h"

namespace lodestone::render {
namespace {

constexpr int half_side = 8;  // of the grid
constexpr float far_away = 1e6f;

}  // namespace

std::vector<glm::vec4> focus_rays(const View& view) {
  std::vector<glm::ivec2> points;
  for (int y = -half_side; y <= half_side; ++y) {
    for (int x = -half_side; x <= half_side; ++x) points.emplace_back(x, y);
  }
  const auto square = [](const glm::ivec2& p) { return p.x * p.x + p.y * p.y; };
  std::stable_sort(points.begin(), points.end(),
                   [&](const glm::ivec2& a, const glm::ivec2& b) { return square(a) < square(b); });
  std::vector<glm::vec4> rays;
  for (const glm::ivec2& point : points) {
    const glm::vec2 at = glm::vec2(point) / float(half_side + 1);
    const glm::vec3 offset = view.right * at.x + view.up * at.y;
    const glm::vec3 origin = view.perspective ? view.origin : view.origin + offset;
    const glm::vec3 direction = glm::normalize(view.perspective ? view.forward + offset : view.forward);
    rays.emplace_back(origin, 0.0f);
    rays.emplace_back(direction, 1e30f);
  }
  return rays;
}

float focus_of(const View& view, const std::vector<glm::vec4>& rays, const std::vector<glm::uvec4>& hits) {
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].w == layout::no_index) continue;
    return std::bit_cast<float>(hits[i].x) *
           glm::dot(glm::vec3(rays[2 * i + 1]), glm::normalize(view.forward));
  }
  return far_away;
}

}  // namespace lodestone::render
