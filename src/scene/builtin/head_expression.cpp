// SPDX-License-Identifier: MIT
#include "lodestone/scene/builtin/head_expression.h"

#include <cmath>

namespace lodestone::scene::builtin {
namespace {

constexpr float jaw_angle = 0.36f;
constexpr glm::vec3 jaw_hinge(0, -0.22f, -0.08f);

const std::array<Shape, 18> shapes = {{
    {"jawOpen", {.jaw = 1}},
    {"smile", {.smile = 1}},
    {"frown", {.frown = 1}},
    {"grin", {.smile = 0.5f, .grin = 1}},
    {"pucker", {.pucker = 1}},
    {"puff", {.puff = 1}},
    {"sneer", {.sneer = 1}},
    {"browUp", {.brow_up = 1}},
    {"browDown", {.brow_down = 1}},
    {"blinkLeft", {.blink = {1, 0}}},
    {"blinkRight", {.blink = {0, 1}}},
    {"eyesWide", {.wide = 1}},
    {"lookLeft", {.look_left = 1}},
    {"lookRight", {.look_left = -1}},
    {"lookUp", {.look_up = 1}},
    {"lookDown", {.look_up = -1}},
    {"tongueOut", {.jaw = 0.55f, .tongue = 1}},
    {"surprise", {.jaw = 0.6f, .pucker = 0.6f, .brow_up = 1, .wide = 0.9f}},
}};

// A bump on either side of the face, and the sign of the side `rest` is on.
float both(Aim rest, Aim centre, Aim radius) {
  return bump({std::abs(rest.azimuth), rest.elevation}, centre, radius);
}
float side_of(Aim rest) {
  return rest.azimuth < 0 ? -1.0f : 1.0f;
}

// +1 above the mouth, -1 below. In elliptic coordinates whose foci are the corners of the mouth, the angle
// goes smoothly from one to the other around a corner, and jumps only across the slit.
float mouth_side(Aim rest) {
  const Aim line = mouth_line(glm::clamp(rest.azimuth / mouth_half_width, -1.0f, 1.0f));
  const float x = rest.azimuth / mouth_half_width;
  const float y = (rest.elevation - line.elevation) / mouth_half_width;
  const float b = x * x + y * y - 1;
  const float sine = std::sqrt(glm::clamp(0.5f * (std::sqrt(b * b + 4 * y * y) - b), 0.0f, 1.0f));
  const float reach = std::sqrt(x * x + y * y);
  const float full = std::min(sine * (1 + 0.35f * reach), 1.0f);
  return (y < 0 ? -1.0f : 1.0f) * full * (1.5f - 0.5f * full * full);
}

}  // namespace

std::span<const Shape> head_shapes() {
  return shapes;
}

Aim mouth_line(float across) {
  return {mouth_half_width * across, -0.475f + 0.045f * across * across + 0.012f * across};
}

Aim skin_slide(Aim rest, const Expression& e) {
  const float side = side_of(rest);
  const Aim corner = mouth_line(1);
  Aim slide;
  const auto add = [&](float amount, float azimuth, float elevation) {
    slide.azimuth += amount * azimuth * side;
    slide.elevation += amount * elevation;
  };
  if (e.smile != 0 || e.frown != 0 || e.pucker != 0) {
    // The line of the mouth bends into a parabola.
    const float t = std::min(std::abs(rest.azimuth) / mouth_half_width, 1.1f);
    const float mouth = both(rest, {0.20f, corner.elevation}, {0.58f, 0.36f});
    add(e.smile * mouth, 0.10f * t, 0.13f * t * t - 0.025f);
    add(e.frown * mouth, -0.02f * t, 0.02f - 0.12f * t * t);
    const float lips = both(rest, {0.10f, corner.elevation}, {0.55f, 0.32f});
    add(e.pucker * lips, -0.48f * std::abs(rest.azimuth), 0);
  }
  if (e.brow_up != 0 || e.brow_down != 0) {
    const float brow = both(rest, {0.38f, 0.50f}, {0.62f, 0.36f});
    add(e.brow_up * brow, 0, 0.12f);
    add(e.brow_down * brow, -0.05f * glm::smoothstep(0.0f, 0.25f, std::abs(rest.azimuth)), -0.09f);
  }
  if (e.grin != 0 || e.jaw != 0) {
    const float lips = bump(rest, {0, corner.elevation}, {0.60f, 0.42f}) * mouth_side(rest);
    add(e.grin * lips, 0, lips > 0 ? 0.075f : 0.060f);
    add(e.jaw * std::max(lips, 0.0f), 0, 0.030f);
    add(e.grin * both(rest, corner, {0.30f, 0.30f}), 0.03f, 0.02f);
  }
  if (e.sneer != 0) add(e.sneer * both(rest, {0.15f, -0.33f}, {0.24f, 0.24f}), 0.015f, 0.085f);
  return slide;
}

float skin_swell(Aim rest, const Expression& e) {
  float swell = 0;
  if (e.smile != 0) swell += e.smile * 0.05f * both(rest, {0.52f, -0.20f}, {0.28f, 0.22f});
  if (e.puff != 0) swell += e.puff * 0.13f * both(rest, {0.56f, -0.42f}, {0.45f, 0.36f});
  if (e.pucker != 0) swell += e.pucker * 0.10f * both(rest, {0, -0.47f}, {0.34f, 0.30f});
  if (e.brow_down != 0) swell += e.brow_down * 0.02f * both(rest, {0.17f, 0.42f}, {0.25f, 0.22f});
  if (e.sneer != 0) swell += e.sneer * 0.035f * both(rest, {0.17f, -0.14f}, {0.16f, 0.16f});
  return swell;
}

float jaw_share(Aim rest) {
  // Not the neck, nor what lies behind the hinge.
  return (0.5f - 0.5f * mouth_side(rest)) * glm::smoothstep(-1.22f, -0.92f, rest.elevation) *
         (1 - glm::smoothstep(0.95f, 1.65f, std::abs(rest.azimuth)));
}

glm::vec3 turn_jaw(glm::vec3 point, float share, const Expression& e) {
  const float angle = share * e.jaw * jaw_angle;
  if (angle == 0) return point;
  const float s = std::sin(angle), c = std::cos(angle);
  const glm::vec3 d = point - jaw_hinge;
  return jaw_hinge + glm::vec3(d.x, d.y * c - d.z * s, d.y * s + d.z * c);
}

glm::vec3 skin_point(Aim rest, const Expression& e, float lift) {
  glm::vec3 p = head_point(rest + skin_slide(rest, e));
  const float swell = skin_swell(rest, e) + lift;
  if (swell != 0) p += swell * head_normal(p);
  return turn_jaw(p, jaw_share(rest), e);
}

}  // namespace lodestone::scene::builtin
