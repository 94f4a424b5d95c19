// SPDX-License-Identifier: MIT
// The edge loops around an eye: from the face over the lid to its edge, and through the slit into the
// eyeball.
#include <cmath>

#include "lodestone/scene/builtin/head_skin.h"

namespace lodestone::scene::builtin {
namespace {

constexpr uint32_t skin_rows = 21;  // of the ring's rows those on the face; the last is the edge of the lid

// The edge of a lid in the eye's own angles: `across` from -1 (inner corner) to 1.
glm::vec2 lid_edge(float across, bool upper, float blink, const Expression& e) {
  constexpr float half_width = 0.74f;
  const float arch = std::pow(std::max(1 - std::abs(across * across * across), 0.0f), 0.62f);
  const float follow = 0.16f * e.look_up;  // lids go with the gaze
  const float open = upper ? 0.52f + 0.17f * e.wide + follow - 0.10f * e.brow_down
                           : -0.44f - 0.08f * e.wide + 0.10f * e.smile + 0.5f * follow;
  const float closed = -0.20f;
  // The upper lid is highest towards the nose, the lower one lowest towards the temple.
  const float lean = (upper ? -0.07f : 0.05f) * across * (1 - across * across) * (1 - blink);
  return {half_width * across, glm::mix(open, closed, blink) * arch + lean + 0.06f * across};
}

glm::vec3 eye_direction(glm::vec2 angles) {
  const float c = std::cos(angles.y);
  return {std::sin(angles.x) * c, std::sin(angles.y), std::cos(angles.x) * c};
}

}  // namespace

void HeadSkin::pose_eye(const Ring& ring, float side, const Expression& e,
                        std::vector<glm::vec3>& out) const {
  const glm::vec3 centre(side * eye_centre.x, eye_centre.y, eye_centre.z);
  const uint32_t around = uint32_t(ring.border.size()), half = around / 2;
  const uint32_t quarter =
      uint32_t(ring.hi.y - ring.lo.y) / 2;  // samples from a corner of the hole to a corner of the eye
  const float blink = e.blink[side > 0 ? 0 : 1];
  for (uint32_t column = 0; column < around; ++column) {
    const uint32_t u = (column + quarter) % around;
    const bool upper = u > half;
    const float turn = float(upper ? around - u : u) / float(half);
    const float even = 2 * turn - 1;
    const float across = side * glm::mix(even, -std::cos(3.14159265f * turn), 0.35f);
    const auto edge_aim = [&](float shut, const Expression& by) {
      const glm::vec3 d = eye_direction(lid_edge(across, upper, shut, by));
      return aim_at(centre + lid_radius * glm::vec3(side * d.x, d.y, d.z));
    };
    const Aim start = aims_[ring.border[column]];
    const Aim edge = edge_aim(blink, e);
    for (uint32_t row = 1; row < skin_rows; ++row) {
      const float x = float(row) / float(skin_rows - 1);
      const float s = 1 - std::pow(1 - x, 1.4f);
      // The edge is a soft rim.
      const float rim = 0.010f * bump((x - 0.97f) / 0.25f);
      out[ring_vertex(ring, column, row)] = skin_point(start + s * (edge - start), e, 0, rim);
    }
    // Through the slit: the first two rows belong to the lid, the others rest inside the eyeball.
    const glm::vec3 lid = out[ring_vertex(ring, column, skin_rows - 1)] - centre;
    const glm::vec3 inner = head_point(edge_aim(0, Expression{})) - centre;
    constexpr std::array<float, 5> depths = {0.955f, 0.87f, 0.74f, 0.62f, 0.5f};
    for (uint32_t k = 0; k < depths.size(); ++k)
      out[ring_vertex(ring, column, skin_rows + k)] = centre + depths[k] * (k < 2 ? lid : inner);
  }
}

void HeadSkin::color_eye(const Ring& ring, float side, std::vector<glm::vec4>& out) const {
  const uint32_t around = uint32_t(ring.border.size()), half = around / 2;
  const uint32_t quarter = uint32_t(ring.hi.y - ring.lo.y) / 2;
  const glm::vec3 lash(0.05f, 0.018f, 0.012f), wet(0.62f, 0.25f, 0.20f);
  for (uint32_t column = 0; column < around; ++column) {
    const bool upper = (column + quarter) % around > half;
    for (uint32_t row = 1; row < ring.rows; ++row) {
      const Aim edge{side * 0.40f, 0.15f};
      const Aim aim = aims_[ring.border[column]];
      const float s = float(row) / float(skin_rows - 1);
      glm::vec3 color = skin_color(aim + 0.5f * std::min(s, 1.0f) * (edge - aim));
      if (row + 1 >= skin_rows) color = upper ? lash : wet;
      if (row + 2 == skin_rows && upper) color = glm::mix(color, lash, 0.6f);
      out[ring_vertex(ring, column, row)] = glm::vec4(color, 1);
    }
  }
  for (int y = ring.lo.y + 1; y < ring.hi.y; ++y)
    for (int x = ring.lo.x + 1; x < ring.hi.x; ++x)
      out[lattice_.vertex({x, y, lattice_.cells().z})] = glm::vec4(wet, 1);
}

}  // namespace lodestone::scene::builtin
