// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/arithmetic.h"
#include "lodestone/layout/frame.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;
using glm::vec3;
using glm::vec4;
using layout::uintBitsToFloat;

struct Rows {
  vec4 r0, r1, r2;
};

template <class Probe>
class Blend : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t vertex) {
    const uvec4 range = this->load(vertex_ranges_, vertex);
    const uvec4 position_bits = this->load(base_positions_, vertex);
    const uvec4 normal_bits = this->load(base_normals_, vertex);
    const uvec4 tangent_bits = push_.tangents != 0 ? this->load(base_tangents_, vertex) : uvec4(0);
    vec3 position = as_vec3(position_bits);
    vec3 normal = as_vec3(normal_bits);
    vec3 tangent = as_vec3(tangent_bits);
    for (uint32_t i = range.x; i < range.y; ++i) {
      const uvec4 entry = this->load(morph_positions_, i);
      const vec3 normal_delta = as_vec3(this->load(morph_normals_, i));
      const float weight = uintBitsToFloat(this->load(weights_, entry.x));
      position = position +
                 weight * vec3(uintBitsToFloat(entry.y), uintBitsToFloat(entry.z), uintBitsToFloat(entry.w));
      normal = normal + weight * normal_delta;
      if (push_.tangents != 0) tangent = tangent + weight * as_vec3(this->load(morph_tangents_, i));
    }

    Rows rows = weighted_matrix(range.z);
    for (uint32_t i = range.z + 1; i < range.w; ++i) {
      const Rows more = weighted_matrix(i);
      rows.r0 = rows.r0 + more.r0;
      rows.r1 = rows.r1 + more.r1;
      rows.r2 = rows.r2 + more.r2;
    }
    const vec3 r0(rows.r0), r1(rows.r1), r2(rows.r2);
    const vec3 moved(layout::dot3(r0, position) + rows.r0.w, layout::dot3(r1, position) + rows.r1.w,
                     layout::dot3(r2, position) + rows.r2.w);
    this->store(positions_, vertex, as_bits(layout::flush_tiny3(moved), 0));

    const vec3 c0 = layout::cross3(r1, r2), c1 = layout::cross3(r2, r0), c2 = layout::cross3(r0, r1);
    vec3 turned(layout::dot3(c0, normal), layout::dot3(c1, normal), layout::dot3(c2, normal));
    if (layout::dot3(r0, c0) < 0.0f) turned = turned * -1.0f;
    this->store(normals_, vertex, as_bits(layout::normalize_or(turned, vec3(0, 0, 1)), normal_bits.w));
    if (push_.tangents != 0) {
      const vec3 along(layout::dot3(r0, tangent), layout::dot3(r1, tangent), layout::dot3(r2, tangent));
      this->store(tangents_, vertex, as_bits(layout::normalize_or(along, vec3(0)), tangent_bits.w));
    }
  }

 private:
  Rows weighted_matrix(uint32_t influence) {
    const uint64_t matrix = this->load(influences_, 2 * uint64_t(influence));
    const float weight = uintBitsToFloat(this->load(influences_, 2 * uint64_t(influence) + 1));
    return {as_vec4(this->load(matrices_, 3 * matrix)) * weight,
            as_vec4(this->load(matrices_, 3 * matrix + 1)) * weight,
            as_vec4(this->load(matrices_, 3 * matrix + 2)) * weight};
  }

  Quads base_positions_ = this->quads(0), base_normals_ = this->quads(1), base_tangents_ = this->quads(2);
  Quads vertex_ranges_ = this->quads(3);
  Quads morph_positions_ = this->quads(4), morph_normals_ = this->quads(5), morph_tangents_ = this->quads(6);
  Words influences_ = this->words(7), weights_ = this->words(8);
  Quads matrices_ = this->quads(9);
  Quads positions_ = this->quads(10), normals_ = this->quads(11), tangents_ = this->quads(12);
  layout::BlendPush push_ = this->template push<layout::BlendPush>();
};

}  // namespace

void blend(const CpuDispatch& dispatch) {
  run_pass<Blend>(dispatch, 2048);
}

}  // namespace lodestone::cpu_fallback
