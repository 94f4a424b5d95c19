// SPDX-License-Identifier: MIT
// What the lips hide: two rows of teeth and a tongue.
#include <cmath>

#include "lodestone/scene/builtin/head_parts.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;

// Thickness of a tube with round ends; `along` from 0 to 1, `cap` the share of the length that an end takes.
float round_ends(float along, float cap) {
  const float x = std::min({along, 1 - along, cap}) / cap;
  return std::sqrt(std::max(1 - (1 - x) * (1 - x), 0.0f));
}

struct Arch {
  float half_width, front, back;  // x, and z of the foremost and the hindmost tooth
  float low, high;                // y
  int teeth;
};
constexpr Arch upper_teeth = {0.285f, 0.775f, 0.34f, -0.600f, -0.43f, 10};
constexpr Arch lower_teeth = {0.258f, 0.715f, 0.34f, -0.710f, -0.590f, 10};

glm::vec3 tooth_point(const Arch& arch, float along, float angle) {
  const float turn = (along - 0.5f) * pi;
  const glm::vec3 outward = glm::normalize(
      glm::vec3(std::sin(turn) * (arch.front - arch.back), 0, std::cos(turn) * arch.half_width));
  const glm::vec3 spine(arch.half_width * std::sin(turn), 0.5f * (arch.low + arch.high),
                        glm::mix(arch.back, arch.front, std::cos(turn)));
  // Rounded bars with a notch between two teeth, deepest in front and at the free edge.
  const float between = std::abs(std::sin(float(arch.teeth) * pi * along));
  const float notch = 1 - bump(between / 0.35f);
  const float end = round_ends(along, 0.05f);
  const float c = std::cos(angle), s = std::sin(angle);
  const float height = 0.5f * (arch.high - arch.low) * (end > 0 ? 0.88f + 0.12f * notch : 0.8f);
  const float depth = 0.030f * end * (0.86f + 0.14f * notch);
  const auto square = [](float x) { return std::copysign(std::pow(std::abs(x), 0.6f), x); };
  return spine + glm::vec3(0, height * square(c), 0) + outward * (depth * square(s));
}

// The middle line of the tongue, from its root to its tip.
glm::vec3 tongue_spine(float along, float out) {
  const glm::vec3 in(0, -0.66f + 0.07f * bump(along - 0.45f), glm::mix(0.12f, 0.655f, along));
  const float over = glm::smoothstep(0.45f, 1.0f, along);
  const glm::vec3 stretched(0, -0.63f + 0.135f * glm::smoothstep(0.0f, 0.55f, along) - 0.20f * over * over,
                            glm::mix(0.12f, 1.16f, along) - 0.06f * over * over);
  return glm::mix(in, stretched, out);
}

glm::vec3 tongue_point(float along, float angle, const Expression& e) {
  const glm::vec3 spine = tongue_spine(along, e.tongue);
  const glm::vec3 forward =
      glm::normalize(tongue_spine(along + 0.01f, e.tongue) - tongue_spine(along - 0.01f, e.tongue));
  const glm::vec3 side(1, 0, 0), up = glm::cross(forward, side);
  const float end = round_ends(along, 0.35f);
  const float c = std::cos(angle), s = std::sin(angle);
  const float width = 0.15f * glm::mix(0.15f, 1.0f, end);
  const float groove = s > 0 ? 0.022f * bump(c / 0.45f) * end : 0;
  return spine + side * (width * c) + up * (0.050f * end * s - groove);
}

void sample(const ZippedTube& tube, std::vector<glm::vec3>& out,
            const std::function<glm::vec3(float along, float angle)>& point) {
  for (const ZippedTube::Sample& sample : tube.samples())
    out.push_back(snap(point(float(sample.row) / float(tube.rows() - 1),
                             2 * pi * float(sample.column) / float(tube.columns()))));
}

}  // namespace

Mesh head_teeth(uint32_t material) {
  Mesh mesh;
  mesh.name = "teeth";
  const ZippedTube upper(12, 101);
  const ZippedTube lower(12, 101, uint32_t(upper.samples().size()));
  add_grid(mesh, upper.chart());
  add_grid(mesh, lower.chart());
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression& e) {
    std::vector<glm::vec3> out;
    sample(upper, out, [](float along, float angle) { return tooth_point(upper_teeth, along, angle); });
    sample(lower, out,
           [&](float along, float angle) { return turn_jaw(tooth_point(lower_teeth, along, angle), 1, e); });
    return out;
  });
  return mesh;
}

Mesh head_tongue(uint32_t material) {
  Mesh mesh;
  mesh.name = "tongue";
  const ZippedTube tube(24, 29);
  add_grid(mesh, tube.chart());
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression& e) {
    std::vector<glm::vec3> out;
    sample(tube, out,
           [&](float along, float angle) { return turn_jaw(tongue_point(along, angle, e), 1, e); });
    return out;
  });
  return mesh;
}

}  // namespace lodestone::scene::builtin
