// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/emitters.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/path.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/environment_kernel-inl.h"
#include "lodestone/cpu_fallback/varying/surface_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

HWY_ATTR inline DrawnLight select(bvec1 condition, const DrawnLight& yes, const DrawnLight& no) {
  return {select(condition, yes.direction, no.direction), select(condition, yes.distance, no.distance),
          select(condition, yes.radiance, no.radiance), select(condition, yes.density, no.density)};
}

template <class Probe, uint32_t source_count, bool is_layered>
class PathVertex : public EnvironmentKernel<SurfaceKernel<Probe, source_count, is_layered>, 26> {
 public:
  explicit PathVertex(const CpuDispatch& dispatch)
      : EnvironmentKernel<SurfaceKernel<Probe, source_count, is_layered>, 26>(dispatch) {
    if (push_.vertex != 0) this->stand_for(going_on_.words + 1);
  }

  HWY_ATTR void operator()() {
    const uvec4 hit = this->load_own(this->hits), along = this->load_own(rays_, 2, 1);
    const vec3 direction = as_vec3(along);
    this->scattered = push_.vertex != 0;
    const bvec1 alive = !(uintBitsToFloat(along.w) < 0.0f);
    path_ = push_.vertex == 0 ? first_path() : stored_path(this->load_own(paths_));
    added_ = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    contribution_ = vec3(0.0f, 0.0f, 0.0f);
    shadow_ = next_ = no_ray();
    if (const Where here(*this, alive && hit.w == no_index); here.any()) {
      const vec1 density = this->environment_pdf(direction) * push_.sky_chance;
      const vec3 sky = path_.throughput * this->environment_radiance(direction) * met_weight(path_, density);
      added_ = select(this->active(), vec4(sky.x, sky.y, sky.z, 0.0f), added_);
    }
    if (const Where here(*this, alive && hit.w != no_index); here.any()) scatter(hit, direction);
    this->store_own(rays_, as_bits(next_.origin, floatBitsToUint(next_.tmin)), 2);
    this->store_own(rays_, as_bits(next_.direction, floatBitsToUint(next_.tmax)), 2, 1);
    this->store_own(paths_, as_bits(path_.throughput, floatBitsToUint(path_.density)));
    this->store_own(contributions_, as_bits(contribution_, 0u));
    this->store_own(shadow_rays_, as_bits(shadow_.origin, floatBitsToUint(shadow_.tmin)), 2);
    this->store_own(shadow_rays_, as_bits(shadow_.direction, floatBitsToUint(shadow_.tmax)), 2, 1);
    if (push_.vertex != 0) added_.w = 0.0f;
    if (push_.first == 0) added_ = added_ + as_vec4(this->load_own(radiance_));
    this->store_own(radiance_, as_bits(added_));
  }

 private:
  using SurfacePoint = typename SurfaceKernel<Probe, source_count, is_layered>::SurfacePoint;

  // What follows from the active invocations' hits.
  HWY_ATTR void scatter(const uvec4& hit, const vec3& direction) {
    const SurfacePoint point = this->locate_hit(hit);
    const Surface surface = this->surface_of(point, direction);
    const Bsdf bsdf = surface_bsdf(surface, is_layered);
    if (is_layered) {
      const vec3 passed = path_.throughput * transmittance(surface, uintBitsToFloat(hit.x));
      path_.throughput = select(this->active(), passed, path_.throughput);
    }
    vec3 emitted = path_.throughput * emitted_radiance(surface);
    if (emitting_ != 0) {
      const vec1 met = uintBitsToFloat(hit.x), cosine = abs1(dot3(surface.geometric, direction));
      const vec1 density = seen_density(this->drawn_density(point), met * met, cosine);
      emitted = emitted * met_weight(path_, density * push_.emitter_chance);
    }
    added_ = select(this->active(), vec4(emitted.x, emitted.y, emitted.z, 1.0f), added_);
    const auto draw = [&](uint use) HWY_ATTR { return this->draw(push_, vertex_pair(push_.vertex, use)); };
    const DrawnLight light = draw_light(surface, draw(of_light).x, draw(of_light_direction));
    const vec3 direct = direct_light(path_, bsdf, light, push_.vertex >= push_.last_vertex);
    const bvec1 lit = this->active() && max_component(direct) > 0.0f;
    const vec1 side = select(dot3(light.direction, surface.geometric) < 0.0f, -1.0f, 1.0f);
    shadow_ = select(lit, leaving_ray(surface, light.direction, side, light.distance), shadow_);
    contribution_ = select(lit, direct, contribution_);

    const vec2 choice = draw(of_lobe);
    const BsdfSample drawn = sample_bsdf(bsdf, choice.x, draw(of_direction));
    Path path = path_;
    path.throughput = path.throughput * drawn.weight;
    path.density = drawn.density;
    path = survived(path, push_.vertex, choice.y);
    path_.throughput = select(this->active(), path.throughput, path_.throughput);
    path_.density = select(this->active(), path.density, path_.density);
    if (push_.vertex >= push_.last_vertex) return;
    const Where here(*this, max_component(path.throughput) > 0.0f);
    if (!here.any()) return;
    const vec1 side_of_next = select(drawn.through, -1.0f, 1.0f);
    next_ = select(this->active(), leaving_ray(surface, drawn.direction, side_of_next, 1e30f), next_);
    this->add(going_on_, 0, this->active_count());
    if (this->placing != placing_cones) return;
    const FrameRecord& frame = this->frames[0];
    this->store_cone(this->cone_from(
        point, surface, scattered_spread(drawn.density, frame.tolerance_spread, frame.steepest)));
  }

  HWY_ATTR DrawnPoint load_drawn() {
    uvec4 coat(0u, 0u, 0u, 0u);
    if (is_layered) coat = this->load_own(drawn_points_, drawn_quads, 3);
    return stored_point(this->load_own(drawn_points_, drawn_quads),
                        this->load_own(drawn_points_, drawn_quads, 1),
                        this->load_own(drawn_points_, drawn_quads, 2), coat);
  }

  HWY_ATTR uvec1 drawn_light(vec1 choice) {
    const uvec1 number(choice * drawn_numbers), last(push_.lights - 1);
    uvec1 light = 0u;
    for (uint step = push_.light_step; step != 0; step >>= 1) {
      uvec1 place = light + step;
      place = select(place < last, place, last);
      LaneWords first(place);
      for (uint32_t& word : first.at) word = lights_[word].first_number;
      light = select(number >= first.lanes(), place, light);
    }
    return light;
  }

  HWY_ATTR DrawnLight draw_light(const Surface& surface, vec1 choice, vec2 xi) {
    DrawnLight drawn{vec3(0.0f, 0.0f, 0.0f), 0.0f, vec3(0.0f, 0.0f, 0.0f), 0.0f};
    this->for_each_value(drawn_light(choice), [&](uint32_t index) HWY_ATTR {
      const LightRecord& light = lights_[index];
      const float chance = float(light.numbers) / drawn_numbers;
      if (emitting_ != 0 && light.kind == light_emitters) {
        drawn = select(this->active(), emitted_light(load_drawn(), surface, chance), drawn);
        return;
      }
      DrawnLight here;
      if (light.kind == light_sky) {
        const auto chosen = this->sample_environment(xi);
        here.direction = chosen.direction;
        here.distance = 1e30f;
        here.density = chosen.pdf * chance;
        here.radiance = this->environment_radiance(chosen.direction) / here.density;
      } else {
        const Arrival arrival = arriving_light(light, surface.position, surface.normal);
        here.direction = arrival.direction;
        here.distance = arrival.distance;
        here.density = 0.0f;
        here.radiance = vec3(light.color) * (arrival.falloff / chance);
      }
      drawn = select(this->active(), here, drawn);
    });
    return drawn;
  }

  Quads rays_ = this->quads(19);
  Structs<LightRecord> lights_ = this->template structs<LightRecord>(20);
  Quads contributions_ = this->quads(21), shadow_rays_ = this->quads(22), radiance_ = this->quads(23),
        paths_ = this->quads(24);
  Words going_on_ = this->words(25);
  Quads drawn_points_ = this->quads(28);
  uint32_t emitting_ = this->constant(3);
  PathPush push_ = this->template push<PathPush>();

  // Of the invocations that run.
  Path path_;
  vec4 added_;
  vec3 contribution_;
  Ray shadow_, next_;
};

LODESTONE_LAYERED_SURFACE_BLOCK_FUNCTION(path, PathVertex)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(path_block);

void path(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 512, HWY_DYNAMIC_DISPATCH(path_block));
}

}  // namespace lodestone::cpu_fallback
#endif
