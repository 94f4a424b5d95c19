// SPDX-License-Identifier: MIT
// What moves in the face: an expression is a handful of amounts, and every part of the head can be posed by
// one.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "lodestone/scene/builtin/head_shape.h"

namespace lodestone::scene::builtin {

// Amounts from 0 (rest) to 1 (full), sides as {left, right}, the head's own.
struct Expression {
  float jaw = 0;               // drops
  float smile = 0, frown = 0;  // the corners of the mouth
  float grin = 0;              // bares the teeth
  float pucker = 0, puff = 0;  // lips forward; cheeks blown up
  float sneer = 0;             // nose and upper lip drawn up
  float brow_up = 0, brow_down = 0;
  std::array<float, 2> blink{0, 0};
  float wide = 0;                    // lids drawn back
  float look_left = 0, look_up = 0;  // -1 to 1
  float tongue = 0;                  // out
};

struct Shape {
  const char* name;
  Expression expression;
};
std::span<const Shape> head_shapes();

// How the skin slides over the head, as a change of aim.
Aim skin_slide(Aim rest, const Expression& expression);
// How far it lifts off along the normal, in units.
float skin_swell(Aim rest, const Expression& expression);
// The share of the jaw's turn that skin takes part in: 0 the upper face, 1 the chin.
float jaw_share(Aim rest);
// Turns a point about the hinge of the jaw by `share` of the expression's angle.
glm::vec3 turn_jaw(glm::vec3 point, float share, const Expression& expression);

// Where the skin that rests at an aim is, raised by `lift` along the normal: slides, swells, turns with the
// jaw.
glm::vec3 skin_point(Aim rest, const Expression& expression, float lift = 0);

// The line where the lips meet at rest, from -1 (right corner) to 1.
Aim mouth_line(float across);
inline constexpr float mouth_half_width = 0.34f;  // azimuth of its corners

}  // namespace lodestone::scene::builtin
