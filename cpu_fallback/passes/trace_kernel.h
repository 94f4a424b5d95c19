// SPDX-License-Identifier: MIT
// What the traversals share: a ray, its hit, and its state from dispatch to dispatch
// (shaders/geometry_image/trace.glsl).
#pragma once

#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/detail_nodes.h"
#include "lodestone/layout/motion.h"
#include "lodestone/layout/objects.h"

namespace lodestone::cpu_fallback {

// `objects`, `roots`, `times`, the four buffers of levels of detail and `ray_list` come in slots from this
// one on.
template <class Probe, size_t objects_slot>
class TraceKernel : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

 protected:
  struct State {
    layout::Hit best;
    glm::uvec4 place;  // as layout/trace.h says
  };

  uint32_t ray_index(uint32_t invocation) {
    return push_.listed != 0 ? this->load(ray_list_, uint64_t(invocation) + 1) : invocation;
  }

  layout::Ray load_ray(uint32_t index) {
    const glm::uvec4 from = this->load(rays_, 2 * uint64_t(index)),
                     along = this->load(rays_, 2 * uint64_t(index) + 1);
    return layout::stored_ray(from, along);
  }

  // When a ray sees the quads, as the geometry images at both ends of a segment have them (layout/motion.h).
  struct Moving {
    uint64_t image = 0;  // first texel
    float passed = 0;
  };
  bool moves() const { return segments_ != 0; }
  // The hierarchy that the ray goes through.
  uint32_t root(uint32_t index, Moving& moving) {
    const uint32_t object = instanced_ ? this->load(roots_, index) : 0;
    if (!moves()) return object;
    const layout::Moment moment =
        layout::moment_of(layout::uintBitsToFloat(this->load(times_, index)), segments_);
    moving = {uint64_t(push_.image_texels) * moment.segment, moment.fraction};
    return object + push_.objects * moment.segment;
  }
  layout::ObjectRecord load_object(uint32_t object) {
    const uint64_t first = 4 * uint64_t(object);
    return layout::object_record(this->load(objects_, first), this->load(objects_, first + 1),
                                 this->load(objects_, first + 2), this->load(objects_, first + 3));
  }

  // Levels of detail (layout/detail.h).
  bool detailed() const { return detailed_; }
  void load_tolerance(uint32_t index) {
    if (!detailed()) return;
    tolerance_.camera = {push_.camera, push_.camera_width, push_.camera_spread};
    tolerance_.scattered = layout::no_cone();
    if (push_.scattered == 0) return;
    const uint64_t first = 2 * uint64_t(index);
    tolerance_.scattered = layout::stored_cone(this->load(cones_, first), this->load(cones_, first + 1));
  }
  layout::NodeDetail load_detail(uint64_t number) {
    return layout::node_detail(this->load(node_details_, 2 * number),
                               this->load(node_details_, 2 * number + 1));
  }
  const layout::Tolerance& tolerance() const { return tolerance_; }

  // False: this ray has nothing to do in this dispatch.
  bool begin_ray(uint32_t index, const layout::Ray& ray, State& state) {
    state = {{ray.tmax, 0, 0, layout::no_index}, {0, 0, layout::trace_unfinished, layout::no_index}};
    visits_ = 0;
    if (push_.resume == layout::resume_nothing) {
      if (!instanced_ && !(ray.tmax < 0.0f)) this->probe.ray();  // else counted where it enters
      return true;
    }
    if (push_.resume == layout::resume_unanswered) {
      if (this->load(hits_, index).w == layout::unanswered) return true;
      this->store(states_, index, {0, 0, layout::trace_finished, layout::no_index});
      return false;
    }
    state.place = this->load(states_, index);
    if (layout::trace_status(state.place) == layout::trace_restart) return true;
    const glm::uvec4 bits = this->load(hits_, index);
    state.best = {layout::uintBitsToFloat(bits.x), layout::uintBitsToFloat(bits.y),
                  layout::uintBitsToFloat(bits.z), bits.w};
    return layout::trace_status(state.place) == layout::trace_unfinished;
  }

  void end_ray(uint32_t index, State state) {
    if (any_hit() && state.best.primitive != layout::no_index) state.best = {0, 0, 0, 0};
    const bool unfinished = layout::trace_status(state.place) == layout::trace_unfinished;
    const uint32_t primitive = !resumable() && unfinished ? layout::unanswered : state.best.primitive;
    this->store(hits_, index, as_bits({state.best.t, state.best.u, state.best.v}, primitive));
    if (resumable()) this->store(states_, index, state.place);
    if (unfinished) this->add(pending_, 0, 1);
    if (this->constant(1) != 0) {
      this->store(steps_, index,
                  (push_.resume != layout::resume_nothing ? this->load(steps_, index) : 0) + visits_);
    }
  }

  void count_step(uint32_t boxes = 1) {
    ++visits_;
    this->probe.step(boxes);
  }

  glm::vec3 corner(uint32_t texel, const Moving& moving) {
    glm::vec3 point = as_vec3(this->load(geometry_, moving.image + texel));
    if (moves()) {
      const glm::uvec4 next = this->load(geometry_, moving.image + push_.image_texels + texel);
      point = layout::moved3(point, as_vec3(next), moving.passed);
    }
    if (detailed()) {
      const uint32_t parent = this->load(collapses_, 2 * uint64_t(texel));
      const float radius = layout::uintBitsToFloat(this->load(collapses_, 2 * uint64_t(texel) + 1));
      const glm::vec3 to = as_vec3(this->load(geometry_, moving.image + parent));
      point = layout::slid(point, to, layout::collapse_of(layout::tolerance_at(tolerance_, point), radius));
    }
    return point;
  }

  // Where the quad's own bound has said `enter`; unless that was of a whole segment, or of corners that have
  // not slid yet.
  void test_leaf(uint32_t texel, uint32_t stride, const Moving& moving, const layout::Ray& ray,
                 const layout::Slabs& slabs, const layout::Shear& shear, uint32_t next, float enter,
                 layout::Hit& best) {
    if (moves() || detailed()) return test_quad(texel, stride, moving, ray, slabs, shear, next, best);
    layout::intersect_quad(corner(texel, moving), corner(texel + 1, moving), corner(texel + stride, moving),
                           corner(texel + stride + 1, moving), ray, shear, next, enter, texel, best);
    this->probe.triangles(2);
  }

  // Where it has not been asked yet.
  void test_quad(uint32_t texel, uint32_t stride, const Moving& moving, const layout::Ray& ray,
                 const layout::Slabs& slabs, const layout::Shear& shear, uint32_t next, layout::Hit& best) {
    test_quad_of({texel, 1, stride, 0}, moving, ray, slabs, shear, next, best);
  }
  // The quad that node `number` is, where it is whole.
  void test_whole(uint64_t number, const Moving& moving, const layout::Ray& ray, const layout::Slabs& slabs,
                  const layout::Shear& shear, uint32_t next, layout::Hit& best) {
    test_quad_of(this->load(coarse_quads_, number), moving, ray, slabs, shear, next, best);
  }
  // `quad`: corner a, how far b and c are from it in texels, and the level of detail.
  void test_quad_of(const glm::uvec4& quad, const Moving& moving, const layout::Ray& ray,
                    const layout::Slabs& slabs, const layout::Shear& shear, uint32_t next,
                    layout::Hit& best) {
    const glm::vec3 a = corner(quad.x, moving), b = corner(quad.x + quad.y, moving),
                    c = corner(quad.x + quad.z, moving), d = corner(quad.x + quad.y + quad.z, moving);
    this->probe.triangles(2);
    const layout::Bound bound = layout::quad_bound(a, b, c, d);
    const float enter = layout::slab_enter(slabs, bound.lo, bound.hi, ray.tmin);
    if (!(enter <= layout::slab_exit(slabs, bound.lo, bound.hi, best.t))) return;
    layout::intersect_quad(a, b, c, d, ray, shear, next, enter, quad.x | quad.w << (layout::level_shift - 1),
                           best);
  }

  bool any_hit() const { return any_hit_; }
  bool instanced() const { return instanced_; }
  bool resumable() const { return resumable_; }

  Quads rays_ = this->quads(0), geometry_ = this->quads(1), hits_ = this->quads(2), states_ = this->quads(3);
  Words steps_ = this->words(4), pending_ = this->words(5);
  layout::TracePush push_ = this->template push<layout::TracePush>();

 private:
  Quads objects_ = this->quads(objects_slot);
  Words roots_ = this->words(objects_slot + 1), times_ = this->words(objects_slot + 2);
  Words collapses_ = this->words(objects_slot + 3);
  Quads node_details_ = this->quads(objects_slot + 4), coarse_quads_ = this->quads(objects_slot + 5),
        cones_ = this->quads(objects_slot + 6);
  Words ray_list_ = this->words(objects_slot + 7);
  layout::Tolerance tolerance_{};
  bool any_hit_ = this->constant(0) != 0, instanced_ = this->constant(2) != 0;
  uint32_t segments_ = this->constant(3), visits_ = 0;
  bool detailed_ = this->constant(4) != 0, resumable_ = this->constant(5) != 0;
};

// Those of single nodes: the hierarchy in 32 bits.
template <class Probe, size_t objects_slot>
class NodesKernel : public TraceKernel<Probe, objects_slot> {
 public:
  using TraceKernel<Probe, objects_slot>::TraceKernel;

 protected:
  // Where the ray enters the bound, and whether it does before `tmax`. `above`: the number of the node above
  // in the detail of nodes; null: there is none.
  struct Entry {
    float enter;
    bool inside;
  };
  Entry enter_node(const glm::uvec4& lo, const glm::uvec4& hi, const layout::Slabs& slabs, float tmin,
                   float tmax, const uint64_t* above) {
    glm::vec3 low = as_vec3(lo), high = as_vec3(hi);
    if (this->detailed() && above != nullptr) {
      const glm::vec3 margin = layout::child_margin(this->load_detail(*above), this->tolerance());
      low = low - margin;
      high = high + margin;
    }
    const float enter = layout::slab_enter(slabs, low, high, tmin);
    return {enter, enter <= layout::slab_exit(slabs, low, high, tmax)};
  }
  bool is_whole(uint64_t number) {
    return this->detailed() && layout::is_whole(this->load_detail(number), this->tolerance());
  }

  Quads nodes_lo_ = this->quads(6), nodes_hi_ = this->quads(7);
};

}  // namespace lodestone::cpu_fallback
