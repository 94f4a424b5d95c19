// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/arithmetic.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;
using glm::vec3;

template <class Probe>
class Rasterise : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t texel) {
    const uvec4 source = this->load(texel_map_, texel);
    uvec4 point(0), direction(0);
    if (source.w != 0) {
      const uvec4 triangle = this->load(triangles_, source.x);
      const float b1 = layout::uintBitsToFloat(source.y), b2 = layout::uintBitsToFloat(source.z);
      const float b0 = 1.0f - b1 - b2;
      point = as_bits(layout::flush_tiny3(weighted(positions_, triangle, b0, b1, b2)), source.w);
      direction = as_bits(weighted(normals_, triangle, b0, b1, b2), 0);
    }
    this->store(geometry_, texel, point);
    this->store(normal_map_, texel, direction);
  }

 private:
  vec3 weighted(const Quads& vertices, const uvec4& triangle, float b0, float b1, float b2) {
    const vec3 v0 = as_vec3(this->load(vertices, triangle.x)), v1 = as_vec3(this->load(vertices, triangle.y)),
               v2 = as_vec3(this->load(vertices, triangle.z));
    return v0 * b0 + v1 * b1 + v2 * b2;
  }

  Quads texel_map_ = this->quads(0), triangles_ = this->quads(1);
  Quads positions_ = this->quads(2), normals_ = this->quads(3);
  Quads geometry_ = this->quads(4), normal_map_ = this->quads(5);
};

}  // namespace

void rasterise(const CpuDispatch& dispatch) {
  run_pass<Rasterise>(dispatch, 4096);
}

}  // namespace lodestone::cpu_fallback
