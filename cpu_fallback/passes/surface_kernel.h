// SPDX-License-Identifier: MIT
// The buffers that surface.h reads, slots 0 to 15 of `mask`, `shade` and `aov`, and that header itself: the
// one piece of the kernels that is compiled by both languages as it stands.
#pragma once

#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/shading.h"
#include "lodestone/layout/trace.h"

namespace lodestone::cpu_fallback {

template <class Probe>
class SurfaceKernel : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

 protected:
  using uint = uint32_t;
  using vec2 = glm::vec2;
  using vec3 = glm::vec3;
  using vec4 = glm::vec4;
  using uvec4 = glm::uvec4;

  void count_read(uint32_t words) { this->probe.read(words); }

  Quads hits = this->quads(0), geometry = this->quads(1), normal_map = this->quads(2),
        texel_map = this->quads(3), triangles = this->quads(4), positions = this->quads(5),
        normals = this->quads(6), tangents = this->quads(7), texcoords = this->quads(8);
  Words images = this->words(9), srgb_table = this->words(10);
  Quads charts = this->quads(11);
  Structs<layout::PartRecord> parts = this->template structs<layout::PartRecord>(12);
  Structs<layout::MaterialRecord> materials = this->template structs<layout::MaterialRecord>(13);
  Structs<layout::TextureRecord> textures = this->template structs<layout::TextureRecord>(14);
  Structs<layout::FrameRecord> frames = this->template structs<layout::FrameRecord>(15);

#define LOAD4(result, buffer, i) result = this->load(buffer, i)
#define LOAD1(result, buffer, i) result = this->load(buffer, i)
  // Names of the layout that the header uses unqualified.
  using ChartRecord = layout::ChartRecord;
  using PartRecord = layout::PartRecord;
  using MaterialRecord = layout::MaterialRecord;
  using TextureRecord = layout::TextureRecord;
  using Surface = layout::Surface;
  using TexelPair = layout::TexelPair;
  static constexpr uint no_index = layout::no_index, chart_grid = layout::chart_grid;
  static float uintBitsToFloat(uint bits) {
    return layout::uintBitsToFloat(bits);
  }
  static ChartRecord chart_record(uvec4 a, uvec4 b) {
    return layout::chart_record(a, b);
  }
  static float dot3(vec3 a, vec3 b) {
    return layout::dot3(a, b);
  }
  static vec3 cross3(vec3 a, vec3 b) {
    return layout::cross3(a, b);
  }
  static vec3 normalize_or(vec3 v, vec3 fallback) {
    return layout::normalize_or(v, fallback);
  }
  static float saturate(float x) {
    return layout::saturate(x);
  }
  static vec4 unpack_rgba8(uint rgba) {
    return layout::unpack_rgba8(rgba);
  }
  static vec4 unpack_vertex_color(uint rgba) {
    return layout::unpack_vertex_color(rgba);
  }
  static float max2(float a, float b) {
    return layout::max2(a, b);
  }
  static float largest_abs(vec3 v) {
    return layout::largest_abs(v);
  }
  static vec2 transform_texcoord(const TextureRecord& record, vec2 uv) {
    return layout::transform_texcoord(record, uv);
  }
  static TexelPair texel_pair(float x, uint size, uint wrap, uint nearest) {
    return layout::texel_pair(x, size, wrap, nearest);
  }
#include "lodestone/layout/surface.h"
#undef LOAD4
#undef LOAD1
};

}  // namespace lodestone::cpu_fallback
