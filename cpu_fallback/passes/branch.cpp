// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/path.h"
#include "lodestone/layout/recursion.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/branch.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/surface_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

HWY_ATTR inline Branch select(bvec1 condition, const Branch& yes, const Branch& no) {
  return {select(condition, yes.throughput, no.throughput), select(condition, yes.depth, no.depth),
          select(condition, yes.left, no.left)};
}

template <class Probe, uint32_t source_count, bool is_layered>
class BranchRays : public SurfaceKernel<Probe, source_count, is_layered> {
 public:
  explicit BranchRays(const CpuDispatch& dispatch)
      : SurfaceKernel<Probe, source_count, is_layered>(dispatch) {
    if (push_.vertex != 0) this->stand_for(going_on_.words + 1);
  }

  HWY_ATTR void operator()() {
    const uvec4 hit = this->load_own(this->hits), along = this->load_own(rays_, 2, 1);
    branch_ = push_.vertex == 0 ? first_branch() : stored_branch(this->load_own(paths_));
    next_ = no_ray();
    cone_ = no_cone();
    this->scattered = push_.vertex != 0;
    const bvec1 alive = !(uintBitsToFloat(along.w) < 0.0f);
    const bvec1 goes_on = alive && hit.w != no_index && branch_.depth < push_.last_vertex;
    if (const Where here(*this, goes_on); here.any()) scatter(hit, as_vec3(along));
    if (const Where here(*this, next_.tmax < 0.0f && branch_.left != 0u); here.any()) take_waiting();
    if (const Where here(*this, !(next_.tmax < 0.0f)); here.any())
      this->add(going_on_, 0, this->active_count());
    this->store_own(rays_, as_bits(next_.origin, floatBitsToUint(next_.tmin)), 2);
    this->store_own(rays_, as_bits(next_.direction, floatBitsToUint(next_.tmax)), 2, 1);
    this->store_own(paths_, branch_bits(branch_));
    if (this->placing == placing_cones) this->store_cone(cone_);
  }

 private:
  using SurfacePoint = typename SurfaceKernel<Probe, source_count, is_layered>::SurfacePoint;

  // The first of three quads, or with cones five.
  HWY_ATTR uvec1 place_of(uvec1 slot) const {
    return (slot * push_.stride + this->own_index()) * (this->placing == placing_cones ? 5u : 3u);
  }

  HWY_ATTR void scatter(const uvec4& hit, const vec3& direction) {
    const SurfacePoint point = this->locate_hit(hit);
    const Surface surface = this->surface_of(point, direction);
    Branch branch = branch_;
    if (is_layered) branch.throughput = branch.throughput * transmittance(surface, uintBitsToFloat(hit.x));
    const Bsdf bsdf = surface_bsdf(surface, is_layered);
    branch.depth = branch.depth + 1u;
    if (this->constant(3) == recursion_glossy) {
      follow_drawn(point, surface, bsdf, branch);
    } else {
      follow_mirrored(point, surface, bsdf, branch);
    }
  }

  HWY_ATTR void follow_drawn(const SurfacePoint& point, const Surface& surface, const Bsdf& bsdf,
                             Branch branch) {
    const auto draw = [&](uint use) HWY_ATTR { return this->draw(push_, vertex_pair(push_.vertex, use)); };
    const BsdfSample drawn = sample_bsdf(without_diffuse(bsdf), draw(of_lobe).x, draw(of_direction));
    branch.throughput = flush_lost3(branch.throughput * drawn.weight);
    const bvec1 carries = this->active() && !(max_component(branch.throughput) < smallest_throughput);
    const vec1 side = select(drawn.through, -1.0f, 1.0f);
    next_ = select(carries, leaving_ray(surface, drawn.direction, side, 1e30f), next_);
    if (this->placing == placing_cones) {
      const FrameRecord& frame = this->frames[0];
      const vec1 spread = scattered_spread(drawn.density, frame.tolerance_spread, frame.steepest);
      cone_ = select(this->active(), this->cone_from(point, surface, spread), cone_);
    }
    branch_ = select(this->active(), branch, branch_);
  }

  HWY_ATTR void follow_mirrored(const SurfacePoint& point, const Surface& surface, const Bsdf& bsdf,
                                Branch branch) {
    const MirrorRays two = mirror_rays(bsdf, surface);
    const vec3 mirrored = flush_lost3(branch.throughput * two.mirrored_weight),
               passed = flush_lost3(branch.throughput * two.passed_weight);
    const bvec1 mirrors = !(max_component(mirrored) < smallest_throughput),
                passes = !(max_component(passed) < smallest_throughput);
    const Ray through = leaving_ray(surface, two.passed, -1.0f, 1e30f);
    if (this->placing == placing_cones) {
      const RayCone cone = this->cone_from(point, surface, vec1(this->frames[0].tolerance_spread));
      cone_ = select(this->active(), cone, cone_);
    }
    if (const Where both(*this, mirrors && passes); both.any()) {
      const uvec1 place = place_of(branch.left);
      Branch waiting = branch;
      waiting.throughput = passed;
      this->store(branches_, place, as_bits(through.origin, floatBitsToUint(through.tmin)));
      this->store(branches_, place, as_bits(through.direction, floatBitsToUint(through.tmax)), 1, 1);
      this->store(branches_, place, branch_bits(waiting), 1, 2);
      if (this->placing == placing_cones) {
        this->store(branches_, place, as_bits(cone_.apex, floatBitsToUint(cone_.width)), 1, 3);
        this->store(branches_, place, uvec4(floatBitsToUint(cone_.spread), 0u, 0u, 0u), 1, 4);
      }
      branch.left = select(this->active(), branch.left + 1u, branch.left);
    }
    branch.throughput = select(mirrors, mirrored, passed);
    next_ = select(this->active() && mirrors, leaving_ray(surface, two.mirrored, 1.0f, 1e30f), next_);
    next_ = select(this->active() && !mirrors && passes, through, next_);
    branch_ = select(this->active(), branch, branch_);
  }

  HWY_ATTR void take_waiting() {
    const uvec1 left = branch_.left - 1u, place = place_of(left);
    const Ray ray = stored_ray(this->load(branches_, place), this->load(branches_, place, 1, 1));
    Branch branch = stored_branch(this->load(branches_, place, 1, 2));
    branch.left = left;
    if (this->placing == placing_cones) {
      const RayCone cone =
          stored_cone(this->load(branches_, place, 1, 3), this->load(branches_, place, 1, 4));
      cone_ = select(this->active(), cone, cone_);
    }
    next_ = select(this->active(), ray, next_);
    branch_ = select(this->active(), branch, branch_);
  }

  Quads rays_ = this->quads(19), paths_ = this->quads(20), branches_ = this->quads(21);
  Words going_on_ = this->words(22);
  BranchPush push_ = this->template push<BranchPush>();

  // Of the invocations that run.
  Branch branch_;
  Ray next_;
  RayCone cone_;
};

LODESTONE_LAYERED_SURFACE_BLOCK_FUNCTION(branch, BranchRays)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(branch_block);

void branch(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 512, HWY_DYNAMIC_DISPATCH(branch_block));
}

}  // namespace lodestone::cpu_fallback
#endif
