// SPDX-License-Identifier: MIT
// The eyeballs, and the picture on them.
#include <cmath>

#include "lodestone/scene/builtin/head_parts.h"
#include "lodestone/scene/builtin/surface.h"
#include "lodestone/scene/builtin/texel.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;
constexpr float iris_angle = 0.56f;  // from the gaze to the rim of the iris
constexpr float look_angle = 0.45f;
constexpr int cells = 18;

// Turned so that +Z becomes the gaze.
glm::vec3 gaze(glm::vec3 p, const Expression& e) {
  const float pitch = look_angle * 0.75f * e.look_up, yaw = look_angle * e.look_left;
  const float sp = std::sin(pitch), cp = std::cos(pitch), sy = std::sin(yaw), cy = std::cos(yaw);
  p = {p.x, p.y * cp + p.z * sp, p.z * cp - p.y * sp};
  return {p.x * cy + p.z * sy, p.y, p.z * cy - p.x * sy};
}

// A slowly varying number in 0..1 of an angle, `count` periods of it around.
float fibre(float angle, float count, float phase) {
  return 0.5f + 0.5f * std::sin(angle * count + phase);
}

glm::vec3 eye_color(float radius, float angle) {
  const glm::vec3 white(0.93f, 0.92f, 0.90f), veins(0.90f, 0.74f, 0.70f);
  if (radius > iris_angle * 1.06f) return glm::mix(white, veins, 0.8f * glm::smoothstep(0.8f, 1.5f, radius));
  const float r = radius / iris_angle;
  const glm::vec3 inner(0.62f, 0.80f, 0.30f), outer(0.05f, 0.42f, 0.42f), rim(0.01f, 0.07f, 0.10f);
  const float streak =
      0.55f * fibre(angle + 0.15f * std::sin(9 * r), 23, 1) + 0.45f * fibre(angle, 41, 2.5f * r);
  glm::vec3 color = glm::mix(inner, outer, glm::smoothstep(0.35f, 0.80f, r + 0.22f * (streak - 0.5f)));
  color *= 0.75f + 0.5f * streak;
  // Light falls through the cornea onto the far side of the iris: brighter below.
  color *= 1.0f - 0.45f * std::sin(angle) * glm::smoothstep(0.3f, 0.7f, r);
  color = glm::mix(color, rim, glm::smoothstep(0.80f, 0.97f, r));
  color = glm::mix(glm::vec3(0.004f), color, glm::smoothstep(0.40f, 0.46f, r));
  return glm::mix(color, white, glm::smoothstep(1.0f, 1.06f, r));
}

}  // namespace

// Around the gaze in the centre, distance the angle from it: half the width is the back of the eye.
Image iris_image() {
  Image image;
  image.name = "iris";
  image.width = image.height = 512;
  for (uint32_t y = 0; y < image.height; ++y)
    for (uint32_t x = 0; x < image.width; ++x) {
      const glm::vec2 p((float(x) + 0.5f) / float(image.width) * 2 - 1,
                        1 - (float(y) + 0.5f) / float(image.height) * 2);
      const glm::vec3 color = eye_color(glm::length(p) * pi, std::atan2(p.y, p.x));
      for (int channel = 0; channel < 3; ++channel) image.rgba.push_back(color_texel(color[channel]));
      image.rgba.push_back(255);
    }
  return image;
}

Mesh head_eyes(uint32_t material) {
  Mesh mesh;
  mesh.name = "eyes";
  std::vector<glm::vec3> directions;
  for (int side = 0; side < 2; ++side) {
    const BoxLattice lattice(glm::ivec3{cells}, uint32_t(directions.size()));
    for (const BoxLattice::Face face : BoxLattice::faces) add_grid(mesh, lattice.chart(face));
    for (const glm::ivec3& point : lattice.points()) {
      const glm::vec3 d = cube_sphere_direction(lattice, point);
      directions.push_back(d);
      const float angle = std::acos(glm::clamp(d.z, -1.0f, 1.0f)) / pi;
      const float flat = std::sqrt(d.x * d.x + d.y * d.y);
      const glm::vec2 p = flat > 0 ? glm::vec2(d.x, -d.y) / flat * angle : glm::vec2(angle, 0);
      mesh.texcoords[0].push_back(snap(0.5f + 0.5f * p));
    }
  }
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression& e) {
    std::vector<glm::vec3> out;
    for (size_t v = 0; v < directions.size(); ++v) {
      const float side = v < directions.size() / 2 ? 1.0f : -1.0f;
      // The left eye and its mirror image; a slight bulge of the cornea catches the light.
      const float bulge = 0.035f * bump(std::acos(glm::clamp(directions[v].z, -1.0f, 1.0f)) / 0.75f);
      const glm::vec3 centre(side * eye_centre.x, eye_centre.y, eye_centre.z);
      out.push_back(snap(centre + eye_radius * (1 + bulge) * gaze(directions[v], e)));
    }
    return out;
  });
  return mesh;
}

}  // namespace lodestone::scene::builtin
