// SPDX-License-Identifier: MIT
// The edge loops around the mouth: from the face over the lips, where they meet, and into the cavity behind
// them.
#include <cmath>

#include "lodestone/scene/builtin/head_skin.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;
constexpr uint32_t skin_rows = 14, lip_rows = 11, cavity_rows = 14;
static_assert(skin_rows + lip_rows + cavity_rows == HeadSkin::mouth_ring_rows);

// Height of the red of a lip above or below the line where they meet, in elevation.
float lip_height(float across, bool upper) {
  const float t = across * across;
  if (!upper) return 0.085f * std::pow(1 - t, 0.7f);
  const float bow = bump((std::abs(across) - 0.22f) / 0.35f) - 0.8f * bump(across / 0.2f);
  return 0.060f * std::pow(1 - t, 0.8f) + 0.012f * bow;
}

float lip_fullness(float across, bool upper) {
  return (upper ? 0.040f : 0.055f) * std::pow(1 - across * across, 0.6f);
}

// Where a column meets the other lip: -1 in the right corner of the mouth, 1 in the left.
float across_mouth(float turn) {
  return glm::mix(2 * turn - 1, -std::cos(pi * turn), 0.45f);
}

// From 0 where a lip begins to pi where it meets the other one.
float lip_angle(uint32_t k) {
  return pi * float(k + 1) / float(lip_rows);
}

// 1 in the middle of the mouth, 0 in the corners.
float roundness(float across) {
  return std::sqrt(std::max(1 - across * across, 0.0f));
}

}  // namespace

void HeadSkin::lay_lips(const Ring& ring) {
  for (uint32_t column = 0; column < ring.border.size(); ++column) {
    const Seam seam = ring_seam(ring, column);
    const float across = across_mouth(seam.turn), round = roundness(across), up = seam.upper ? 1.0f : -1.0f;
    const Aim line = mouth_line(across);
    const Aim contact = line + Aim{0, up * 0.0015f * round};
    const Aim border = line + Aim{0.022f * across * (1 - round), up * lip_height(across, seam.upper)};
    const Aim start = aims_[ring.border[column]];
    for (uint32_t row = 1; row < skin_rows; ++row) {
      const float s = 1 - std::pow(1 - float(row) / float(skin_rows - 1), 1.25f);
      aims_[ring_vertex(ring, column, row)] = start + s * (border - start);
    }
    for (uint32_t k = 0; k < lip_rows; ++k)
      aims_[ring_vertex(ring, column, skin_rows + k)] =
          border + 0.5f * (1 - std::cos(lip_angle(k))) * (contact - border);
  }
}

void HeadSkin::pose_mouth(const Ring& ring, const Expression& e, std::vector<glm::vec3>& out) const {
  for (uint32_t column = 0; column < ring.border.size(); ++column) {
    const Seam seam = ring_seam(ring, column);
    const float across = across_mouth(seam.turn);
    for (uint32_t row = 1; row < skin_rows; ++row) {
      const uint32_t v = ring_vertex(ring, column, row);
      out[v] = posed_vertex(v, e);
    }
    for (uint32_t k = 0; k < lip_rows; ++k) {
      const uint32_t v = ring_vertex(ring, column, skin_rows + k);
      out[v] = posed_vertex(v, e, lip_fullness(across, seam.upper) * std::sin(lip_angle(k)));
    }
    // Behind the lips: posed with the jaw shut, then turned with it.
    const uint32_t last = ring_vertex(ring, column, skin_rows + lip_rows - 1);
    const float share = jaw_share(aims_[last]), up = seam.upper ? 1.0f : -1.0f;
    const glm::vec3 meet = turn_jaw(out[last], -share, e);
    for (uint32_t k = 0; k < cavity_rows; ++k) {
      const float d = float(k) / float(cavity_rows - 1);
      const float spread = 0.17f * (1 - std::pow(1 - d, 4.0f)) * (1 - 0.35f * d);
      // First both lips step up, so that one cannot look in between them; then they part.
      glm::vec3 p = meet + (1 - d) * glm::vec3(0, 0.010f * roundness(across), -0.02f);
      // Wider behind the corners, so that one sees teeth there and not the wall.
      p.x *= 1 + 0.20f * bump((d - 0.28f) / 0.30f) - 0.25f * d * d;
      p.y += up * spread * std::pow(roundness(across), 0.35f);
      p.z = glm::mix(p.z, 0.10f, d);
      out[ring_vertex(ring, column, skin_rows + lip_rows + k)] = turn_jaw(p, glm::mix(share, 0.5f, d * d), e);
    }
  }
}

void HeadSkin::color_mouth(const Ring& ring, std::vector<glm::vec4>& out) const {
  const glm::vec3 lip(0.62f, 0.18f, 0.145f), flesh(0.55f, 0.13f, 0.11f), throat(0.12f, 0.015f, 0.015f);
  const uint32_t around = uint32_t(ring.border.size());
  for (uint32_t column = 0; column < around; ++column)
    for (uint32_t row = 1; row < ring.rows; ++row) {
      const Aim aim = aims_[ring.border[column]];
      const float across = across_mouth(ring_seam(ring, column).turn);
      const float s = std::min(float(row) / float(skin_rows), 1.0f);
      const glm::vec3 skin = skin_color(aim + s * (Aim{0.8f * aim.azimuth, -0.475f} - aim));
      // Pales in the corners, where the lips are pinched.
      const float red = glm::smoothstep(float(skin_rows) - 2, float(skin_rows) + 1.5f, float(row)) *
                        (0.3f + 0.7f * glm::smoothstep(0.0f, 0.35f, roundness(across)));
      glm::vec3 color = glm::mix(skin, lip, red);
      const float deep = (float(row) - float(skin_rows + lip_rows)) / cavity_rows;
      color = glm::mix(color, flesh, glm::smoothstep(-0.15f, 0.15f, deep));
      color = glm::mix(color, throat, glm::smoothstep(0.35f, 1.0f, deep));
      out[ring_vertex(ring, column, row)] = glm::vec4(color, 1);
    }
  for (int y = ring.lo.y + 1; y < ring.hi.y; ++y)
    for (int x = ring.lo.x + 1; x < ring.hi.x; ++x)
      out[lattice_.vertex({x, y, lattice_.cells().z})] = glm::vec4(throat, 1);
}

}  // namespace lodestone::scene::builtin
