// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/emitters.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/draw_emitters.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/surface_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

HWY_ATTR inline DrawnPoint select(bvec1 condition, const DrawnPoint& yes, const DrawnPoint& no) {
  return {select(condition, yes.position, no.position),      select(condition, yes.density, no.density),
          select(condition, yes.normal, no.normal),          select(condition, yes.offset, no.offset),
          select(condition, yes.emission, no.emission),      select(condition, yes.coat, no.coat),
          select(condition, yes.coat_normal, no.coat_normal)};
}

template <class Probe, uint32_t source_count, bool is_layered>
class DrawEmitters : public SurfaceKernel<Probe, source_count, is_layered> {
  using Base = SurfaceKernel<Probe, source_count, is_layered>;

 public:
  explicit DrawEmitters(const CpuDispatch& dispatch) : Base(dispatch) {
    if (push_.vertex != 0) this->stand_for(this->words(24).words + 1);
  }

  HWY_ATTR void operator()() {
    const uvec4 hit = this->load_own(this->hits), along = this->load_own(rays_, 2, 1);
    DrawnPoint drawn = nothing_drawn();
    if (const Where here(*this, !(uintBitsToFloat(along.w) < 0.0f) && hit.w != no_index); here.any()) {
      const auto draw = [&](uint pair) HWY_ATTR { return this->draw(push_, pair); };
      const uvec1 number(draw(vertex_pair(push_.vertex, of_light)).x * drawn_numbers);
      if (const Where emitting(*this, number >= push_.first_number); emitting.any()) {
        const SurfacePoint point =
            draw_emitter(push_, draw(emitter_pair(push_.vertex)),
                         draw(vertex_pair(push_.vertex, of_light_direction)), this->moment());
        this->for_each_part(point, [&](const PartRecord&, const MaterialRecord& material) HWY_ATTR {
          drawn = select(this->active(), drawn_point(material, point), drawn);
        });
      }
    }
    this->store_own(drawn_points_, as_bits(drawn.position, floatBitsToUint(drawn.density)), drawn_quads);
    this->store_own(drawn_points_, as_bits(drawn.normal, floatBitsToUint(drawn.offset)), drawn_quads, 1);
    this->store_own(drawn_points_, as_bits(drawn.emission, floatBitsToUint(drawn.coat)), drawn_quads, 2);
    if (is_layered) this->store_own(drawn_points_, as_bits(drawn.coat_normal, 0u), drawn_quads, 3);
  }

 private:
  using Base::base_color_at, Base::drawn_density, Base::emission_at, Base::emitter_numbers, Base::instanced,
      Base::instances, Base::layered, Base::locate, Base::set_place, Base::surface_at, Base::texcoords_at;
  using typename Base::SurfacePoint;

  Quads rays_ = this->quads(19);
  Words emitter_texels = this->words(20), emitter_objects = this->words(21),
        instance_numbers = this->words(22);
  Quads drawn_points_ = this->quads(23);
  EmitterPush push_ = this->template push<EmitterPush>();

#define LOAD4(result, buffer, i) result = this->load(buffer, i)
#define LOAD1(result, buffer, i) result = this->load(buffer, i)
#include "lodestone/layout/draw_emitter.h"
#undef LOAD4
#undef LOAD1
};

LODESTONE_LAYERED_SURFACE_BLOCK_FUNCTION(draw_emitters, DrawEmitters)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(draw_emitters_block);

void draw_emitters(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 512, HWY_DYNAMIC_DISPATCH(draw_emitters_block));
}

}  // namespace lodestone::cpu_fallback
#endif
