// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/motion.h"
#include "lodestone/layout/portion.h"
#include "lodestone/layout/trace.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;
using layout::found_texels, layout::found_vertices;

template <class Probe>
class PortionEnd : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const uvec4 met = this->load(local_hits_, index);
    if (this->constant(1) != 0)
      this->store(steps_, index, this->load(steps_, index) + this->load(local_steps_, index));
    if (met.w == layout::no_index) return;
    if (this->constant(0) != 0) {
      const uvec4 state = this->load(states_, index);
      this->store(states_, index, uvec4(state.x, state.y, layout::trace_finished, state.w));
      this->store(hits_, index, uvec4(0));
      return;
    }
    const uvec4 best = this->load(hits_, index);
    const uint32_t primitive = 2 * whole_texel(met.w >> 1) + (met.w & 1);
    const float t = layout::uintBitsToFloat(met.x), nearest = layout::uintBitsToFloat(best.x);
    if (!(t < nearest || (t == nearest && primitive < best.w))) return;
    this->store(hits_, index, uvec4(met.x, met.y, met.z, primitive));
    if (this->constant(4) == 0) return;
    this->store(found_hits_, index, uvec4(met.x, met.y, met.z, 2 * found_texels * index + (met.w & 1)));
    layout::Moment moment{0, 0};
    if (segments_ != 0)
      moment = layout::moment_of(layout::uintBitsToFloat(this->load(times_, index)), segments_);
    keep_surface(index, met.w, moment);
  }

 private:
  uint32_t whole_texel(uint32_t texel) {
    uint32_t first = 0, end = push_.runs;
    while (first + 1 < end) {
      const uint32_t middle = (first + end) >> 1;
      (this->load(runs_, 2 * uint64_t(middle)) <= texel ? first : end) = middle;
    }
    const uint32_t local = this->load(runs_, 2 * uint64_t(first)),
                   whole = this->load(runs_, 2 * uint64_t(first) + 1);
    return whole + (texel - local);
  }

  void keep_vertex(uint32_t vertex, uint32_t place, uint32_t number) {
    const uvec4 position = this->load(positions_, vertex);
    this->store(found_positions_, place, uvec4(position.x, position.y, position.z, number));
    this->store(found_normals_, place, this->load(normals_, vertex));
    this->store(found_tangents_, place, this->load(tangents_, vertex));
    this->store(found_texcoords_, place, this->load(texcoords_, vertex));
  }

  void keep_triangle(uint32_t triangle, uint32_t place) {
    const uvec4 corners = this->load(triangles_, triangle);
    const uint32_t number = this->load(triangle_numbers_, triangle), first = found_vertices * place;
    for (uint32_t i = 0; i < 3; ++i) keep_vertex(corners[static_cast<glm::length_t>(i)], first + i, number);
    this->store(found_triangles_, place, uvec4(first, first + 1, first + 2, corners.w));
  }

  // What an image says of a texel at a moment.
  glm::vec3 texel_at(const Quads& image, uint64_t texel, const layout::Moment& moment) {
    const glm::vec3 now = as_vec3(this->load(image, texel));
    if (segments_ == 0) return now;
    return layout::moved3(now, as_vec3(this->load(image, texel + push_.image_texels)), moment.fraction);
  }

  void keep_surface(uint32_t index, uint32_t primitive, const layout::Moment& moment) {
    const uint32_t texel = primitive >> 1, upper = primitive & 1, place = sources_ * index;
    const uint32_t image = push_.image_texels * moment.segment;
    const uint64_t number = this->load(geometry_, image + texel).w - 1;
    const layout::ChartRecord chart =
        layout::chart_record(this->load(charts_, 2 * number), this->load(charts_, 2 * number + 1));
    for (uint32_t i = 0; i < found_texels; ++i) {
      const glm::vec3 point = texel_at(geometry_, image + texel + (i & 1) + (i >> 1) * chart.width, moment);
      this->store(found_geometry_, found_texels * index + i, as_bits(point, index + 1));
    }
    uint32_t triangle = chart.first_triangle;
    if (chart.kind == layout::chart_grid) {
      const uint32_t offset = texel - chart.first_texel;
      triangle += 2 * (offset - offset / chart.width) + upper;
    }
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t slot = upper + i, from = texel + (slot & 1) + (slot >> 1) * chart.width;
      this->store(found_normal_map_, found_texels * index + slot,
                  as_bits(texel_at(normal_map_, image + from, moment), 0));
      const uvec4 sample = this->load(texel_map_, from);
      uint32_t own = place;
      if (chart.kind == layout::chart_mapped) {
        own += i;
        keep_triangle(sample.x, own);
      }
      this->store(found_texel_map_, found_texels * index + slot, uvec4(own, sample.y, sample.z, index + 1));
    }
    if (chart.kind != layout::chart_mapped) keep_triangle(triangle, place);
    const uint32_t first_triangle = chart.kind == layout::chart_grid ? place - upper : place;
    this->store(found_charts_, 2 * uint64_t(index), uvec4(found_texels * index, 2, 2, chart.kind));
    uint32_t emitter = chart.first_emitter;
    if (emitter != 0) emitter += whole_texel(texel) - whole_texel(chart.first_texel);
    this->store(found_charts_, 2 * uint64_t(index) + 1, uvec4(first_triangle, 0, 0, emitter));
  }

  Quads local_hits_ = this->quads(0);
  Words local_steps_ = this->words(1);
  Quads hits_ = this->quads(2), states_ = this->quads(3);
  Words steps_ = this->words(4), runs_ = this->words(5), times_ = this->words(6);
  Quads geometry_ = this->quads(7), normal_map_ = this->quads(8), texel_map_ = this->quads(9),
        triangles_ = this->quads(10);
  Words triangle_numbers_ = this->words(11);
  Quads positions_ = this->quads(12), normals_ = this->quads(13), tangents_ = this->quads(14),
        texcoords_ = this->quads(15), charts_ = this->quads(16);
  Quads found_hits_ = this->quads(17), found_geometry_ = this->quads(18), found_normal_map_ = this->quads(19),
        found_texel_map_ = this->quads(20), found_triangles_ = this->quads(21),
        found_positions_ = this->quads(22), found_normals_ = this->quads(23),
        found_tangents_ = this->quads(24), found_texcoords_ = this->quads(25),
        found_charts_ = this->quads(26);
  layout::PortionPush push_ = this->template push<layout::PortionPush>();
  uint32_t sources_ = this->constant(2), segments_ = this->constant(3);
};

LODESTONE_BLOCK_FUNCTION(static, portion_end, PortionEnd)

}  // namespace

void portion_end(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, portion_end_block);
}

}  // namespace lodestone::cpu_fallback
