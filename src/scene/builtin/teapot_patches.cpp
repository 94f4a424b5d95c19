// SPDX-License-Identifier: MIT
#include "lodestone/scene/builtin/teapot_patches.h"

#include <algorithm>
#include <span>

namespace lodestone::scene::builtin {
namespace {

using ControlRow = std::array<glm::vec3, 4>;

// A row of control points around the axis. A quarter is (radius, 0), (radius, tangent), (tangent, radius),
// (0, radius) in X and Z: nearly a circle, as tangent is 0.56 of radius (0.5523 would be nearest).
struct Ring {
  float radius, tangent, height;
};

// A row around a tube, which is alike on both sides of the plane z = 0. A half is first, the same at z =
// width, last at z = width, last.
struct Section {
  glm::vec2 first, last;
  float width;
};

// Rows 0 to 3 are a patch, 3 to 6 the next one and so on.
constexpr std::array<Ring, 13> body = {{{1.4f, 0.784f, 2.4f},  // the rim, from the inside
                                        {1.3375f, 0.749f, 2.53125f},
                                        {1.4375f, 0.805f, 2.53125f},
                                        {1.5f, 0.84f, 2.4f},
                                        {1.75f, 0.98f, 1.875f},
                                        {2, 1.12f, 1.35f},
                                        {2, 1.12f, 0.9f},
                                        {2, 1.12f, 0.45f},
                                        {1.5f, 0.84f, 0.225f},
                                        {1.5f, 0.84f, 0.15f},  // the bottom
                                        {1.5f, 0.84f, 0.075f},
                                        {1.425f, 0.798f, 0},
                                        {0, 0, 0}}};
// Some copies have points 0.002 off the axis in place of the pole, against normals of length 0.
constexpr std::array<Ring, 7> lid = {{{0, 0, 3.15f},
                                      {0.8f, 0.45f, 3.15f},
                                      {0, 0, 2.85f},
                                      {0.2f, 0.112f, 2.7f},
                                      {0.4f, 0.224f, 2.55f},
                                      {1.3f, 0.728f, 2.55f},
                                      {1.3f, 0.728f, 2.4f}}};
constexpr std::array<Section, 7> handle = {{{{-1.6f, 2.025f}, {-1.5f, 2.25f}, 0.3f},
                                            {{-2.3f, 2.025f}, {-2.5f, 2.25f}, 0.3f},
                                            {{-2.7f, 2.025f}, {-3, 2.25f}, 0.3f},
                                            {{-2.7f, 1.8f}, {-3, 1.8f}, 0.3f},
                                            {{-2.7f, 1.575f}, {-3, 1.35f}, 0.3f},
                                            {{-2.5f, 1.125f}, {-2.65f, 0.9375f}, 0.3f},
                                            {{-2, 0.9f}, {-1.9f, 0.6f}, 0.3f}}};
constexpr std::array<Section, 7> spout = {{{{1.7f, 1.425f}, {1.7f, 0.6f}, 0.66f},
                                           {{2.6f, 1.425f}, {3.1f, 0.825f}, 0.66f},
                                           {{2.3f, 2.1f}, {2.4f, 2.025f}, 0.25f},
                                           {{2.7f, 2.4f}, {3.3f, 2.4f}, 0.25f},
                                           {{2.8f, 2.475f}, {3.525f, 2.49375f}, 0.25f},
                                           {{2.9f, 2.475f}, {3.45f, 2.5125f}, 0.15f},
                                           {{2.8f, 2.4f}, {3.2f, 2.4f}, 0.15f}}};

constexpr uint32_t columns_of(const Ring&) {
  return 4;
}
constexpr uint32_t columns_of(const Section&) {
  return 2;
}

ControlRow control_row(const Ring& ring, uint32_t quarter) {
  const float r = ring.radius, t = ring.tangent, y = ring.height;
  ControlRow row = {{{r, y, 0}, {r, y, t}, {t, y, r}, {0, y, r}}};
  for (glm::vec3& p : row)
    for (uint32_t k = 0; k < quarter; ++k) p = {-p.z, p.y, p.x};
  return row;
}

ControlRow control_row(const Section& section, uint32_t half) {
  const glm::vec2 a = section.first, b = section.last;
  const float w = section.width;
  if (half == 0) return {{{a, 0}, {a, w}, {b, w}, {b, 0}}};
  return {{{b, 0}, {b, -w}, {a, -w}, {a, 0}}};
}

template <typename Row>
PatchSheet sheet(const std::string& name, std::span<const Row> rows) {
  PatchSheet out{name, columns_of(rows[0]), {}};
  for (size_t first = 0; first + 3 < rows.size(); first += 3)
    for (uint32_t column = 0; column < out.columns; ++column) {
      BezierPatch& patch = out.patches.emplace_back();
      for (size_t k = 0; k < 4; ++k) {
        const ControlRow row = control_row(rows[first + k], column);
        std::copy(row.begin(), row.end(), patch.begin() + ptrdiff_t(4 * k));
      }
    }
  return out;
}

// Bernstein's polynomials of degree 3 and their derivatives.
struct Weights {
  std::array<float, 4> value, slope;
};

Weights weights_at(float t) {
  const float s = 1 - t;
  return {{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t},
          {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t}};
}

template <typename Points>
glm::vec3 weighted(const std::array<float, 4>& weights, const Points& points) {
  return weights[0] * points[0] + weights[1] * points[1] + weights[2] * points[2] + weights[3] * points[3];
}

}  // namespace

std::vector<PatchSheet> teapot_patches() {
  return {sheet<Ring>("body", body), sheet<Ring>("lid", lid), sheet<Section>("handle", handle),
          sheet<Section>("spout", spout)};
}

PatchSample sample_patch(const BezierPatch& patch, float u, float v) {
  const Weights in_u = weights_at(u), in_v = weights_at(v);
  ControlRow across, slope;  // at u, a control point a row
  for (size_t row = 0; row < 4; ++row) {
    across[row] = weighted(in_u.value, &patch[4 * row]);
    slope[row] = weighted(in_u.slope, &patch[4 * row]);
  }
  return {weighted(in_v.value, across), weighted(in_v.value, slope), weighted(in_v.slope, across)};
}

}  // namespace lodestone::scene::builtin
