// SPDX-License-Identifier: MIT
// From what the camera's rays have hit to the light that they carry, each integrator as passes.
#include "lodestone/layout/emitters.h"
#include "lodestone/layout/recursion.h"
#include "lodestone/render/number_shares.h"
#include "lodestone/render/passes.h"
#include "lodestone/render/ray_list.h"
#include "lodestone/render/renderer_state.h"

namespace lodestone::render {

// Of the paths or rays that go on.
void Renderer::State::count_from_zero() {
  const uint32_t zero = 0;
  backend.upload(going_on.id(), std::as_bytes(std::span(&zero, 1)));
}
uint32_t Renderer::State::counted() {
  uint32_t count = 0;
  backend.download(going_on.id(), std::as_writable_bytes(std::span(&count, 1)), 0);
  return count;
}

// What the shadow rays carry, where nothing is in their way. `scattered`: they come from rays that have been.
bool Renderer::State::add_unblocked(uint32_t count, uint32_t listed, bool scattered,
                                    const Interrupted& interrupted) {
  TraceQuery query{.any_hit = true, .shadow = true, .scattered = scattered};
  if (listed != 0) {
    query.some = &going_on;
    query.some_count = listed;
  }
  if (!trace_masked(shadow, count, query, interrupted)) return false;
  const uint32_t added = listed != 0 ? listed : count;
  run(passes::accumulate, {shadow.hits.id(), contributions.id(), radiance().id(), going_on.id()},
      layout::CountPush{added}, added, {listed != 0 ? 1u : 0u});
  return true;
}

// Of `count` rays, all or those of the list, the ones that go on become the list; the others cast no shadow
// rays any more. How many that are.
uint32_t Renderer::State::list_paths(uint32_t count, bool listed) {
  std::swap(going_on, went_on);
  const RayListing listing{
      passes::list_paths, passes::scan_paths,     primary, count,       listed ? &went_on : nullptr,
      going_on,           layout::resume_nothing, false,   &shadow.rays};
  listing.find(backend);
  listing.place(backend);
  return listing.found(backend);
}

// Of every light, at what the rays have hit; `recursion`: see layout/recursion.h; `listed`: see
// add_unblocked.
bool Renderer::State::direct_light(layout::RayPush push, uint32_t recursion, uint32_t listed,
                                   const Interrupted& interrupted) {
  const uint32_t all = push.rays;
  if (listed != 0) push.rays = listed;
  for (uint32_t light = 0; light < light_count; ++light) {
    push.light = light;
    run(passes::shade,
        surface_buffers(
            primary, {primary.rays.id(), lights.id(), contributions.id(), shadow.rays.id(), radiance().id(),
                      environment.quads.id(), environment.cells.id(), paths.id(), going_on.id()}),
        push, push.rays, surface_constants(recursion, true));
    if (!add_unblocked(all, listed, push.vertex > 0, interrupted)) return false;
  }
  return true;
}

bool Renderer::State::ambient_sample(const layout::RayPush& rays, const Interrupted& interrupted) {
  run(passes::ambient,
      surface_buffers(primary, {primary.rays.id(), contributions.id(), shadow.rays.id(), radiance().id()}),
      layout::AmbientPush{rays.first_ray, rays.rays, rays.sample_index, rays.first, settings.ao_distance},
      rays.rays, plain_constants());
  return add_unblocked(rays.rays, 0, false, interrupted);
}

// Direct light wherever a ray arrives, until none goes on.
bool Renderer::State::recursive_sample(const layout::RayPush& rays, uint32_t recursion,
                                       const Interrupted& interrupted) {
  layout::RayPush light_push = rays;
  uint32_t listed = 0;  // rays of the list `going_on`; at the first vertex there is none
  for (;; ++light_push.vertex) {
    if (light_push.vertex > 0) light_push.first = 0;
    if (!direct_light(light_push, recursion, listed, interrupted)) return false;
    const uint32_t count = listed != 0 ? listed : rays.rays;
    const layout::BranchPush push{rays.first_ray,       count,    rays.sample_index, light_push.vertex,
                                  settings.max_bounces, rays.rays};
    count_from_zero();
    run(passes::branch,
        surface_buffers(primary, {primary.rays.id(), paths.id(), branches.id(), going_on.id()}), push, count,
        surface_constants(recursion, true));
    if (counted() == 0) return true;
    listed = list_paths(count, listed != 0);
    if (listed == 0) return true;
    const TraceQuery query{.scattered = true, .some = &going_on, .some_count = listed};
    if (!trace_masked(primary, rays.rays, query, interrupted)) return false;
  }
}

// A point of what shines, for each path that needs one.
void Renderer::State::draw_emitters(const layout::PathPush& path) {
  // Of them all is on the device, if of nothing else.
  const GeometryImage& shining = portions ? *portions->emitter_image() : *image;
  const layout::EmitterPush push{path.first_ray,
                                 path.rays,
                                 path.sample_index,
                                 path.vertex,
                                 light_choice.first_emitter_number,
                                 instances ? instances->count() : 0,
                                 instances ? greatest_step(instances->count()) : 0,
                                 emitters->half_step()};
  const uint32_t placing = instances ? layout::placing_instances : 0;
  run(passes::draw_emitters,
      surface_buffers(primary, shining.buffers(), primary.hits.id(),
                      emitter_frame ? emitter_frame.id() : frame.id(),
                      {primary.rays.id(), emitters->texels().id(), emitters->objects().id(),
                       instances ? instances->numbers().id() : emitters->objects().id(),
                       emitters->drawn().id(), going_on.id()}),
      push, push.rays, {shining.sources(), materials.layered, 0, 0, placing, settings.shutter_segments});
}

// Vertex by vertex, until no path goes on.
bool Renderer::State::path_sample(const layout::RayPush& rays, const Interrupted& interrupted) {
  // Where other integrators have `recursion`, whether there are emitters.
  const auto constants = surface_constants(emitters ? 1 : 0, true);
  uint32_t listed = 0;  // paths of the list `going_on`; at the first vertex there is none
  for (uint32_t vertex = 0;; ++vertex) {
    const uint32_t count = vertex == 0 ? rays.rays : listed;
    const layout::PathPush push{rays.first_ray,          count,
                                rays.sample_index,       vertex,
                                settings.max_bounces,    light_count,
                                light_choice.step,       vertex == 0 ? rays.first : 0,
                                light_choice.sky_chance, light_choice.emitter_chance};
    if (emitters) draw_emitters(push);
    count_from_zero();
    run(passes::path,
        surface_buffers(primary, {primary.rays.id(), lights.id(), contributions.id(), shadow.rays.id(),
                                  radiance().id(), paths.id(), going_on.id(), environment.quads.id(),
                                  environment.cells.id(), emitters ? emitters->drawn().id() : paths.id()}),
        push, push.rays, constants);
    const bool last = counted() == 0;
    if (!add_unblocked(rays.rays, listed, vertex > 0, interrupted)) return false;
    if (last) return true;
    listed = list_paths(count, listed != 0);
    if (listed == 0) return true;
    const TraceQuery query{.scattered = true, .some = &going_on, .some_count = listed};
    if (!trace_masked(primary, rays.rays, query, interrupted)) return false;
  }
}

bool Renderer::State::integrate(const layout::RayPush& rays, const Interrupted& interrupted) {
  switch (settings.integrator) {
    case Integrator::eye:
    case Integrator::dof:
      return direct_light(rays, layout::recursion_none, 0, interrupted);
    case Integrator::ao:
      return ambient_sample(rays, interrupted);
    case Integrator::specular:
      return recursive_sample(rays, layout::recursion_specular, interrupted);
    case Integrator::glossy:
      return recursive_sample(rays, layout::recursion_glossy, interrupted);
    case Integrator::path:
      return path_sample(rays, interrupted);
  }
  return false;
}

}  // namespace lodestone::render
