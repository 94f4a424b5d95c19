// SPDX-License-Identifier: MIT
// What renderer.cpp and integrators.cpp share.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lodestone/layout/frame.h"
#include "lodestone/layout/recursion.h"
#include "lodestone/render/denoiser.h"
#include "lodestone/render/emitters.h"
#include "lodestone/render/environment_tables.h"
#include "lodestone/render/geometry_image.h"
#include "lodestone/render/instances.h"
#include "lodestone/render/light_choice.h"
#include "lodestone/render/material_tables.h"
#include "lodestone/render/portions.h"
#include "lodestone/render/renderer.h"
#include "lodestone/render/tracing.h"
#include "lodestone/scene/pose_box.h"
#include "lodestone/scene/pose_reach.h"

namespace lodestone::render {

struct Renderer::State {
  Backend& backend;
  const scene::Scene& scene;
  const scene::Assembly& assembly;
  const geometry_image::Atlas& atlas;
  Settings settings;
  MaterialTables materials;
  EnvironmentTables environment;
  EmitterData emitter_data;          // of `path`, else empty
  std::optional<Emitters> emitters;  // none: nothing shines
  // One of the two: all of the surface is on the device, or portions of it come and go.
  std::optional<GeometryImage> image;
  std::optional<Portions> portions;
  scene::PoseReach reach;
  scene::PoseBox pose_box;
  std::optional<Instances> instances;  // none: all of the scene is one object in the world
  std::optional<Denoiser> denoiser;
  std::vector<PassRecord> setup;

  // Rewritten every frame.
  Buffer frame, lights, cameras, cut_out;
  Buffer emitter_frame;      // of the geometry image that emitters are drawn in, where that is another one
  layout::RayCone camera{};  // what rays tolerate that have not been scattered
  RayBuffers primary, shadow, loaded;
  uint32_t loaded_rays = 0;
  bool loaded_together = false;  // see TraceQuery::common_origin
  Buffer cones;
  std::vector<Buffer> radiances;  // sums of samples: of one batch after the other, or of each
  uint32_t batch = 0;
  layout::FrameRecord frame_record{};
  Buffer contributions, paths, branches, beauty, display, aovs;
  // How many rays go on from where they are; and behind that word, from the second vertex on, the numbers of
  // those that came there (layout/ray_list.h). The same of the vertex before.
  Buffer going_on, went_on;
  uint32_t light_count = 0;
  LightChoice light_choice;  // of `path`
  double scene_radius = 0;   // of a sphere round it, at rest
  uint32_t batch_rays = 0;

  State(Backend& device, const scene::Scene& scene_in, const scene::Assembly& assembly_in,
        const geometry_image::Atlas& atlas_in, const Settings& settings_in);

  uint32_t total_rays() const {
    return 64 * layout::tile_count(settings.width) * layout::tile_count(settings.height);
  }

  template <class Push>
  void run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push, uint32_t invocations,
           std::array<uint32_t, pass_constants> constants = {}) {
    backend.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), invocations, constants});
  }

  // Slots 0 to 18 of shaders/geometry_image/surface.glsl for `rays`, on a surface that is theirs or another.
  std::vector<BufferId> surface_buffers(const RayBuffers& rays, const SurfaceBuffers& surface, BufferId hits,
                                        BufferId frame_of_surface,
                                        std::initializer_list<BufferId> more) const {
    std::vector<BufferId> ids = {
        hits, surface.geometry, surface.normal_map, surface.texel_map, surface.triangles, surface.positions,
        surface.normals, surface.tangents, surface.texcoords, materials.images.id(),
        // What the constants leave out nothing reads; any words and quads will do.
        emitters ? emitters->numbers().id() : rays.steps.id(), surface.charts, materials.parts.id(),
        materials.materials.id(), materials.textures.id(), frame_of_surface,
        instances                       ? rays.instances.id()
        : settings.shutter_segments > 0 ? times_of(rays).id()
                                        : rays.steps.id(),
        instances ? instances->records().id() : (has_cones() ? cones : rays.trails).id(),
        has_detail() ? image->detail()->collapses().id() : rays.steps.id()};
    ids.insert(ids.end(), more);
    return ids;
  }
  std::vector<BufferId> surface_buffers(const RayBuffers& rays, std::initializer_list<BufferId> more) const {
    const FoundSurface* found = found_by(rays);
    return surface_buffers(rays, found != nullptr ? found->buffers() : image->buffers(),
                           found != nullptr ? found->hits.id() : rays.hits.id(), frame.id(), more);
  }

  // Of the passes that read them.
  // `scattered`: what the pass works on can have cones.
  std::array<uint32_t, pass_constants> surface_constants(uint32_t recursion = layout::recursion_none,
                                                         bool scattered = false) const {
    const uint32_t placing = instances                  ? layout::placing_instances
                             : scattered && has_cones() ? layout::placing_cones
                                                        : 0;
    return {sources(), materials.layered, environment.map, recursion, placing | kept(), seen_segments()};
  }

  // Of those that take every surface for a plain one.
  std::array<uint32_t, pass_constants> plain_constants() const {
    return {sources(), 0, 0, 0, instances ? layout::placing_instances : kept(), seen_segments()};
  }

  // A shadow ray's time is that of the ray it comes from.
  const Buffer& times_of(const RayBuffers& rays) const {
    return &rays == &shadow ? primary.times : rays.times;
  }

  uint32_t sources() const { return image ? image->sources() : portions->sources(); }
  bool has_detail() const { return image && image->detail(); }

  // What is kept ray by ray is as it was when it was hit.
  uint32_t kept() const { return portions ? layout::placing_found : 0; }
  uint32_t seen_segments() const { return portions ? 0 : settings.shutter_segments; }
  // Null: the surface is there, or nobody asks what these rays hit (where nothing is cut out, shadow rays).
  const FoundSurface* found_by(const RayBuffers& rays) const {
    if (!portions) return nullptr;
    if (&rays == &primary) return &portions->found();
    return &rays == &shadow && materials.has_masks ? &portions->found_by_shadows() : nullptr;
  }

  // Of rays that have been scattered, with levels of detail.
  bool has_cones() const { return static_cast<bool>(cones); }

  bool has_lens() const { return settings.lens_radius > 0 || settings.integrator == Integrator::dof; }

  void make_surface();
  PosedVertices posed(const scene::Pose& pose) const;
  void update(const scene::Pose& pose, const std::vector<Moment>& shutter);
  float find_focus(const View& view);
  void look_from(const View* view);
  double emitter_power() const;
  void begin_frame(const scene::Pose& pose, const View& view, const std::vector<Moment>& shutter);
  void upload_cameras(const layout::FrameRecord& record, const std::vector<Moment>& shutter);
  std::vector<scene::Bounds> object_boxes(const scene::Pose& pose) const;
  bool trace(const RayBuffers& rays, uint32_t count, TraceQuery query, const Interrupted& interrupted);
  bool trace_masked(const RayBuffers& rays, uint32_t count, TraceQuery query, const Interrupted& interrupted);
  void run_camera(const layout::RayPush& push);
  const Buffer& radiance() const { return radiances[radiances.size() > 1 ? batch : 0]; }
  bool add_aovs(uint32_t first_ray, uint32_t count, const Interrupted& interrupted);
  bool add_sample(uint32_t first_ray, uint32_t count, uint32_t sample, const Interrupted& interrupted);
  void resolve(uint32_t first_ray, uint32_t count, uint32_t samples);
  template <class Body>
  bool for_each_batch(const Body& body);
  bool render_at_once(const Interrupted& interrupted);
  uint32_t render_by_samples(const Interrupted& interrupted, const OnSamples& on_samples);
  FrameResult picture(uint32_t samples);

  // integrators.cpp: one sample of a batch whose rays have found what they hit. False: interrupted.
  bool integrate(const layout::RayPush& rays, const Interrupted& interrupted);
  bool direct_light(layout::RayPush push, uint32_t recursion, uint32_t listed,
                    const Interrupted& interrupted);
  bool ambient_sample(const layout::RayPush& rays, const Interrupted& interrupted);
  bool recursive_sample(const layout::RayPush& rays, uint32_t recursion, const Interrupted& interrupted);
  void draw_emitters(const layout::PathPush& push);
  bool path_sample(const layout::RayPush& rays, const Interrupted& interrupted);
  // `listed`: only of so many rays, those of `going_on`; 0: of the first `count`.
  bool add_unblocked(uint32_t count, uint32_t listed, bool scattered, const Interrupted& interrupted);
  uint32_t list_paths(uint32_t count, bool listed);
  void count_from_zero();
  uint32_t counted();
};

}  // namespace lodestone::render
