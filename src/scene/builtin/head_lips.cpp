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

}  // namespace

void HeadSkin::pose_mouth(const Ring& ring, const Expression& e, std::vector<glm::vec3>& out) const {
  const uint32_t around = uint32_t(ring.border.size()), half = around / 2;
  const uint32_t quarter = uint32_t(ring.hi.y - ring.lo.y) / 2;
  for (uint32_t column = 0; column < around; ++column) {
    const uint32_t u = (column + quarter) % around;
    const bool corner = u == 0 || u == half;
    const bool upper = u > half;
    const float turn = float(upper ? around - u : u) / float(half);
    const float across =
        corner ? (u == 0 ? -1.0f : 1.0f) : glm::mix(2 * turn - 1, -std::cos(pi * turn), 0.45f);
    const float round = std::sqrt(1 - across * across);
    const float up = upper ? 1.0f : -1.0f;
    const int lip = upper ? 1 : -1;
    const Aim line = mouth_line(across);
    const Aim contact = line + Aim{0, up * 0.0015f * round};
    const Aim border = line + Aim{0.022f * across * (1 - round), up * lip_height(across, upper)};
    const Aim start = aims_[ring.border[column]];

    for (uint32_t row = 1; row < skin_rows; ++row) {
      const float x = float(row) / float(skin_rows - 1);
      const float s = 1 - std::pow(1 - x, 1.25f);
      out[ring_vertex(ring, column, row)] = skin_point(start + s * (border - start), e, lip);
    }
    for (uint32_t k = 0; k < lip_rows; ++k) {
      const float angle = pi * float(k + 1) / float(lip_rows);
      const float s = 0.5f * (1 - std::cos(angle));
      const float lift = lip_fullness(across, upper) * std::sin(angle);
      out[ring_vertex(ring, column, skin_rows + k)] =
          skin_point(border + s * (contact - border), e, lip, lift);
    }
    // Behind the lips: posed with the jaw shut, then turned with it.
    const float share = jaw_share(contact, lip);
    const glm::vec3 meet = turn_jaw(out[ring_vertex(ring, column, skin_rows + lip_rows - 1)], -share, e);
    for (uint32_t k = 0; k < cavity_rows; ++k) {
      const float d = float(k + 1) / float(cavity_rows);
      const float spread = 0.17f * (1 - std::pow(1 - d, 4.0f)) * (1 - 0.35f * d);
      glm::vec3 p = meet;
      p.x *= 1 - 0.25f * d * d;
      p.y += up * spread * std::sqrt(round);
      p.z = glm::mix(meet.z, 0.10f, d);
      out[ring_vertex(ring, column, skin_rows + lip_rows + k)] = turn_jaw(p, glm::mix(share, 0.5f, d * d), e);
    }
  }
}

void HeadSkin::color_mouth(const Ring& ring, std::vector<glm::vec4>& out) const {
  const glm::vec3 lip(0.62f, 0.19f, 0.16f), flesh(0.45f, 0.09f, 0.08f), throat(0.06f, 0.008f, 0.008f);
  const uint32_t around = uint32_t(ring.border.size());
  for (uint32_t column = 0; column < around; ++column)
    for (uint32_t row = 1; row < ring.rows; ++row) {
      const Aim aim = aims_[ring.border[column]];
      const float s = std::min(float(row) / float(skin_rows), 1.0f);
      const glm::vec3 skin = skin_color(aim + s * (Aim{0.8f * aim.azimuth, -0.475f} - aim));
      const float red = glm::smoothstep(float(skin_rows) - 2, float(skin_rows) + 1.5f, float(row));
      glm::vec3 color = glm::mix(skin, lip, red);
      const float deep = (float(row) - float(skin_rows + lip_rows)) / cavity_rows;
      color = glm::mix(color, flesh, glm::smoothstep(-0.15f, 0.15f, deep));
      color = glm::mix(color, throat, glm::smoothstep(0.25f, 0.9f, deep));
      out[ring_vertex(ring, column, row)] = glm::vec4(color, 1);
    }
  for (int y = ring.lo.y + 1; y < ring.hi.y; ++y)
    for (int x = ring.lo.x + 1; x < ring.hi.x; ++x)
      out[lattice_.vertex({x, y, lattice_.cells().z})] = glm::vec4(throat, 1);
}

}  // namespace lodestone::scene::builtin
