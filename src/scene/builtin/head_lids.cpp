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
  const float open =
      upper ? 0.47f + 0.20f * e.wide + follow - 0.06f * e.brow_down : -0.42f - 0.10f * e.wide + 0.5f * follow;
  const float closed = -0.20f * (1 - across * across);
  // The upper lid is highest towards the nose, the lower one lowest towards the temple.
  const float lean = (upper ? -0.07f : 0.05f) * across * (1 - across * across) * (1 - blink);
  return {half_width * across, glm::mix(open * arch, closed, blink) + lean + 0.06f * across};
}

glm::vec3 eye_direction(glm::vec2 angles) {
  const float c = std::cos(angles.y);
  return {std::sin(angles.x) * c, std::sin(angles.y), std::cos(angles.x) * c};
}

// The aim of the edge at `turn` of the way from the right corner to the left.
Aim edge_aim(float turn, bool upper, float side, const Expression& e) {
  const float across = side * glm::mix(2 * turn - 1, -std::cos(3.14159265f * turn), 0.35f);
  const glm::vec3 d = eye_direction(lid_edge(across, upper, e.blink[side > 0 ? 0 : 1], e));
  return aim_at(glm::vec3(side, 1, 1) * (eye_centre + lid_radius * d));
}

// How far a row is on its way from the border of the hole to the edge of the lid; denser towards the edge.
float row_share(uint32_t row) {
  return 1 - std::pow(1 - float(row) / float(skin_rows - 1), 1.4f);
}

}  // namespace

void HeadSkin::lay_lids(const Ring& ring, float side) {
  for (uint32_t column = 0; column < ring.border.size(); ++column) {
    const Seam seam = ring_seam(ring, column);
    const Aim start = aims_[ring.border[column]];
    const Aim edge = edge_aim(seam.turn, seam.upper, side, Expression{});
    for (uint32_t row = 1; row < skin_rows; ++row)
      aims_[ring_vertex(ring, column, row)] = start + row_share(row) * (edge - start);
  }
}

void HeadSkin::pose_eye(const Ring& ring, float side, const Expression& e,
                        std::vector<glm::vec3>& out) const {
  const glm::vec3 centre = glm::vec3(side, 1, 1) * eye_centre;
  for (uint32_t column = 0; column < ring.border.size(); ++column) {
    const Seam seam = ring_seam(ring, column);
    const uint32_t last = ring_vertex(ring, column, skin_rows - 1);
    const Aim shift = edge_aim(seam.turn, seam.upper, side, e) - aims_[last];
    for (uint32_t row = 1; row < skin_rows; ++row) {
      // What moves the face fades towards the edge of the lid, which keeps to the eyeball.
      const uint32_t v = ring_vertex(ring, column, row);
      const float s = row_share(row), face = 1 - glm::smoothstep(0.2f, 1.0f, s);
      const Aim aim = aims_[v] + face * skin_slide(aims_[v], e) + s * shift;
      const float rim = 0.010f * bump((float(row) / float(skin_rows - 1) - 0.97f) / 0.25f);
      const float lift = face * skin_swell(aims_[v], e) + rim;
      glm::vec3 p = face_point(v, aim);
      if (lift != 0) p += lift * face_normal(v, aim, p);
      out[v] = turn_jaw(p, face * jaw_share(aims_[v]), e);
    }
    // Through the slit: the first two rows belong to the lid, the others rest inside the eyeball.
    constexpr std::array<float, 5> depths = {0.955f, 0.87f, 0.74f, 0.62f, 0.5f};
    for (uint32_t k = 0; k < depths.size(); ++k)
      out[ring_vertex(ring, column, skin_rows + k)] =
          glm::mix(centre, k < 2 ? out[last] : points_[last], depths[k]);
  }
}

void HeadSkin::color_eye(const Ring& ring, float side, std::vector<glm::vec4>& out) const {
  const glm::vec3 lash(0.05f, 0.018f, 0.012f), wet(0.62f, 0.25f, 0.20f);
  for (uint32_t column = 0; column < ring.border.size(); ++column) {
    const Seam seam = ring_seam(ring, column);
    // The line of the lashes thins out around the corners of the eye, the same on both lids where they meet.
    const float corner = std::min(seam.turn, 1 - seam.turn);
    const float line = seam.upper ? glm::mix(0.55f, 1.0f, glm::smoothstep(0.0f, 0.12f, corner))
                                  : 0.55f * (1 - glm::smoothstep(0.0f, 0.16f, corner));
    for (uint32_t row = 1; row < ring.rows; ++row) {
      const Aim edge{side * 0.40f, 0.15f};
      const Aim aim = aims_[ring.border[column]];
      const float s = float(row) / float(skin_rows - 1);
      glm::vec3 color = skin_color(aim + 0.5f * std::min(s, 1.0f) * (edge - aim));
      if (row + 1 >= skin_rows) color = wet;
      color = glm::mix(color, lash, line * glm::clamp(float(row + 4) - float(skin_rows), 0.0f, 2.0f) / 2);
      out[ring_vertex(ring, column, row)] = glm::vec4(color, 1);
    }
  }
  for (int y = ring.lo.y + 1; y < ring.hi.y; ++y)
    for (int x = ring.lo.x + 1; x < ring.hi.x; ++x)
      out[lattice_.vertex({x, y, lattice_.cells().z})] = glm::vec4(wet, 1);
}

}  // namespace lodestone::scene::builtin
