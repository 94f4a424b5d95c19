// SPDX-License-Identifier: MIT
#include "lodestone/render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/layout/frame.h"
#include "lodestone/render/environment_tables.h"
#include "lodestone/render/film.h"
#include "lodestone/render/focus.h"
#include "lodestone/render/passes.h"
#include "lodestone/render/relaxation.h"
#include "lodestone/render/scene_tables.h"
#include "lodestone/render/tracing.h"
#include "lodestone/render/view.h"
#include "lodestone/scene/pose_box.h"
#include "lodestone/scene/pose_reach.h"

namespace lodestone::render {
namespace {

constexpr uint32_t batch_rays = 1u << 18;

template <class T>
void download_all(Backend& backend, const Buffer& buffer, std::vector<T>& items) {
  backend.download(buffer.id(), std::as_writable_bytes(std::span(items)), 0);
}

}  // namespace

struct Renderer::State {
  Backend& backend;
  const scene::Scene& scene;
  const scene::Assembly& assembly;
  const geometry_image::Atlas& atlas;
  Settings settings;
  SceneTables tables;
  EnvironmentTables environment;
  Tracing tracing;
  scene::PoseReach reach;
  scene::PoseBox pose_box;
  std::optional<Relaxation> relaxation;
  std::vector<PassRecord> setup;

  // Rewritten every frame.
  Buffer weights, matrices, positions, normals, tangents, geometry, normal_map;
  Buffer frame, lights;
  RayBuffers primary, shadow, loaded;
  uint32_t loaded_rays = 0;
  Buffer contributions, radiance, paths, alive, beauty, display, aovs;
  uint32_t light_count = 0, sky_lights = 0;

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

  std::vector<BufferId> surface_buffers(const RayBuffers& rays, std::initializer_list<BufferId> more) const {
    std::vector<BufferId> ids = {
        rays.hits.id(),        geometry.id(),         normal_map.id(),        texel_map(),
        tables.triangles.id(), positions.id(),        normals.id(),           tangents.id(),
        tables.texcoords.id(), tables.images.id(),    tables.srgb_table.id(), tables.charts.id(),
        tables.parts.id(),     tables.materials.id(), tables.textures.id(),   frame.id()};
    ids.insert(ids.end(), more);
    return ids;
  }

  bool has_lens() const { return settings.lens_radius > 0 || settings.integrator == Integrator::dof; }

  // Of this frame.
  BufferId texel_map() const { return relaxation ? relaxation->texel_map() : tables.texel_map.id(); }

  void prepare_relaxation();
  void blend(const scene::Pose& pose, const Buffer& blended_positions);
  void update(const scene::Pose& pose);
  float find_focus(const View& view);
  void begin_frame(const scene::Pose& pose, const View& view);
  bool trace_masked(const RayBuffers& rays, uint32_t count, TraceQuery query, const Interrupted& interrupted);
  bool integrate(const layout::RayPush& rays, const Interrupted& interrupted);
  bool eye_sample(layout::RayPush push, const Interrupted& interrupted);
  bool ambient_sample(const layout::RayPush& rays, const Interrupted& interrupted);
  bool path_sample(const layout::RayPush& rays, const Interrupted& interrupted);
  bool add_unblocked(uint32_t count, const Interrupted& interrupted);
  bool render_batch(uint32_t first_ray, uint32_t count, const Interrupted& interrupted);
};

Renderer::State::State(Backend& device, const scene::Scene& scene_in, const scene::Assembly& assembly_in,
                       const geometry_image::Atlas& atlas_in, const Settings& settings_in)
    : backend(device),
      scene(scene_in),
      assembly(assembly_in),
      atlas(atlas_in),
      settings(settings_in),
      tables(device, scene_in, assembly_in, atlas_in),
      environment(device, scene_in),
      tracing(device, atlas_in, tables.leaf_map, settings_in.traversal, settings_in.loop_budget),
      reach(scene_in),
      pose_box(scene_in) {
  check_aovs(settings.aovs);
  const uint64_t vertices = assembly.positions.size(), texels = atlas.texel_map.size();
  weights = Buffer(device, {"weights", assembly.weight_count, 4});
  matrices = Buffer(device, {"matrices", 3 * uint64_t(assembly.matrix_count), 16});
  positions = Buffer(device, {"positions", vertices, 16});
  normals = Buffer(device, {"normals", vertices, 16});
  tangents = Buffer(device, {"tangents", vertices, 16});
  geometry = Buffer(device, {"geometry", texels, 16});
  normal_map = Buffer(device, {"normal_map", texels, 16});
  frame = Buffer(device, {"frame", 1, sizeof(layout::FrameRecord)});
  const uint32_t rays = std::min(batch_rays, total_rays());
  const uint64_t pixels = uint64_t(settings.width) * settings.height;
  primary = RayBuffers(device, "", rays);
  shadow = RayBuffers(device, "shadow_", rays);
  contributions = Buffer(device, {"contributions", rays, 16});
  radiance = Buffer(device, {"radiance", rays, 16});
  paths = Buffer(device, {"paths", settings.integrator == Integrator::path ? rays : 0, 16});
  alive = Buffer(device, {"alive", 1, 4});
  beauty = Buffer(device, {"beauty", pixels, 16});
  display = Buffer(device, {"display", pixels, 16});
  aovs = Buffer(device, {"aovs", settings.aovs.empty() ? 0 : 4 * pixels, 16});
  if (settings.relaxation_sweeps > 0 && atlas.report.mapped_charts > 0) prepare_relaxation();
  setup = device.finish();
}

void Renderer::State::prepare_relaxation() {
  if (atlas.maps.empty()) {
    fail(ExitCode::usage, "--relaxation-sweeps",
         "needs the maps of the charts, and the atlas of {} has none; bake it with --keep-maps", scene.name);
  }
  // By the same pass as every pose, so that the rest pose has stretched nothing, to the bit.
  Buffer rest_positions(backend, {"rest_positions", assembly.positions.size(), 16});
  blend(scene::evaluate(scene, scene::none, 0), rest_positions);
  relaxation.emplace(backend, tables, atlas, std::move(rest_positions));
}

void Renderer::State::blend(const scene::Pose& pose, const Buffer& blended_positions) {
  reach.check(scene, pose);
  const std::vector<float> frame_weights = scene::frame_weights(scene, assembly, pose);
  const std::vector<glm::vec4> frame_matrices = scene::frame_matrices(scene, assembly, pose);
  if (!frame_weights.empty()) backend.upload(weights.id(), std::as_bytes(std::span(frame_weights)));
  backend.upload(matrices.id(), std::as_bytes(std::span(frame_matrices)));
  const auto vertices = static_cast<uint32_t>(assembly.positions.size());
  run(passes::blend,
      {tables.base_positions.id(), tables.base_normals.id(), tables.base_tangents.id(),
       tables.vertex_ranges.id(), tables.morph_positions.id(), tables.morph_normals.id(),
       tables.morph_tangents.id(), tables.influences.id(), weights.id(), matrices.id(),
       blended_positions.id(), normals.id(), tangents.id()},
      layout::BlendPush{vertices, assembly.has_tangents ? 1u : 0u}, vertices);
}

// blend, relax, rasterise, bounds: everything that follows from the pose.
void Renderer::State::update(const scene::Pose& pose) {
  blend(pose, positions);
  if (relaxation) relaxation->run(positions.id(), settings.relaxation_sweeps);
  const auto texels = static_cast<uint32_t>(atlas.texel_map.size());
  run(passes::rasterise,
      {texel_map(), tables.triangles.id(), positions.id(), normals.id(), geometry.id(), normal_map.id()},
      layout::CountPush{texels}, texels);
  tracing.build(geometry, pose_box.of(scene, pose));
}

// By rays through a grid of points of the picture.
float Renderer::State::find_focus(const View& view) {
  const std::vector<glm::vec4> rays = focus_rays(view);
  const auto count = static_cast<uint32_t>(rays.size() / 2);
  const RayBuffers probes(backend, "focus_", count);
  backend.upload(probes.rays.id(), std::as_bytes(std::span(rays)));
  tracing.trace(geometry, probes, count, {}, {});
  std::vector<glm::uvec4> hits(count);
  download_all(backend, probes.hits, hits);
  return focus_of(view, rays, hits);
}

void Renderer::State::begin_frame(const scene::Pose& pose, const View& view) {
  scene::Sky sky;
  const auto records = frame_lights(scene, pose, view, sky);
  light_count = static_cast<uint32_t>(records.size());
  sky_lights = static_cast<uint32_t>(std::count_if(
      records.begin(), records.end(), [](const auto& record) { return record.kind == layout::light_sky; }));
  lights = make_buffer(backend, "lights", sizeof(layout::LightRecord), records);
  layout::FrameRecord record{};
  record.origin = view.origin;
  record.right = view.right;
  record.up = view.up;
  record.forward = view.forward;
  record.perspective = view.perspective ? 1 : 0;
  record.width = settings.width;
  record.height = settings.height;
  record.seed = settings.seed;
  record.spp = settings.spp;
  record.sky_top = sky.top;
  record.sky_horizon = sky.horizon;
  record.sky_bottom = sky.bottom;
  record.filmic = settings.view == ViewTransform::filmic ? 1 : 0;
  record.exposure = std::exp2(settings.exposure);
  if (has_lens()) {
    record.focus = settings.focus_distance > 0 ? settings.focus_distance : find_focus(view);
    const float radius = settings.lens_radius > 0 ? settings.lens_radius : record.focus / 40;
    record.lens_right = glm::normalize(view.right) * radius;
    record.lens_up = glm::normalize(view.up) * radius;
  }
  backend.upload(frame.id(), std::as_bytes(std::span(&record, 1)));
}

// All rays to their end. Where materials cut out texels, hits on those are passed through until none is left;
// the nearest hit has to be found each time, also for shadow rays. False: interrupted.
bool Renderer::State::trace_masked(const RayBuffers& rays, uint32_t count, TraceQuery query,
                                   const Interrupted& interrupted) {
  if (tables.has_masks) query.any_hit = false;
  if (!tracing.trace(geometry, rays, count, query, interrupted)) return false;
  if (!tables.has_masks) return true;
  do {
    run(passes::mask, surface_buffers(rays, {rays.rays.id(), rays.states.id(), tracing.pending().id()}),
        layout::CountPush{count}, count, {tables.sources, tables.layered});
    if (tracing.take_pending() == 0) return true;
  } while (tracing.trace(geometry, rays, count, query, interrupted));
  return false;
}

// What the shadow rays carry, where nothing is in their way. False: interrupted.
bool Renderer::State::add_unblocked(uint32_t count, const Interrupted& interrupted) {
  if (!trace_masked(shadow, count, {.any_hit = true, .shadow = true}, interrupted)) return false;
  run(passes::accumulate, {shadow.hits.id(), contributions.id(), radiance.id()}, layout::CountPush{count},
      count);
  return true;
}

// One sample of a batch whose rays have found what they hit: direct light. False: interrupted.
bool Renderer::State::eye_sample(layout::RayPush push, const Interrupted& interrupted) {
  for (uint32_t light = 0; light < light_count; ++light) {
    push.light = light;
    run(passes::shade,
        surface_buffers(
            primary, {primary.rays.id(), lights.id(), contributions.id(), shadow.rays.id(), radiance.id(),
                      environment.environments.id(), environment.quads.id(), environment.cells.id()}),
        push, push.rays, {tables.sources, tables.layered, environment.map});
    if (!add_unblocked(push.rays, interrupted)) return false;
  }
  return true;
}

bool Renderer::State::ambient_sample(const layout::RayPush& rays, const Interrupted& interrupted) {
  run(passes::ambient,
      surface_buffers(primary, {primary.rays.id(), contributions.id(), shadow.rays.id(), radiance.id()}),
      layout::AmbientPush{rays.first_ray, rays.rays, rays.sample_index, rays.first, settings.ao_distance},
      rays.rays, {tables.sources, tables.layered});
  return add_unblocked(rays.rays, interrupted);
}

// The same by path tracing, vertex by vertex, until no path is left.
bool Renderer::State::path_sample(const layout::RayPush& rays, const Interrupted& interrupted) {
  const uint32_t zero = 0;
  for (uint32_t vertex = 0;; ++vertex) {
    const layout::PathPush push{
        rays.first_ray,       rays.rays,   rays.sample_index, vertex,
        settings.max_bounces, light_count, sky_lights,        vertex == 0 ? rays.first : 0};
    backend.upload(alive.id(), std::as_bytes(std::span(&zero, 1)));
    run(passes::path,
        surface_buffers(primary, {primary.rays.id(), lights.id(), contributions.id(), shadow.rays.id(),
                                  radiance.id(), paths.id(), alive.id()}),
        push, push.rays, {tables.sources, tables.layered});
    uint32_t left = 0;
    backend.download(alive.id(), std::as_writable_bytes(std::span(&left, 1)), 0);
    if (!add_unblocked(push.rays, interrupted)) return false;
    if (left == 0) return true;
    if (!trace_masked(primary, push.rays, {}, interrupted)) return false;
  }
}

bool Renderer::State::integrate(const layout::RayPush& rays, const Interrupted& interrupted) {
  switch (settings.integrator) {
    case Integrator::eye:
    case Integrator::dof:
      return eye_sample(rays, interrupted);
    case Integrator::ao:
      return ambient_sample(rays, interrupted);
    case Integrator::path:
      return path_sample(rays, interrupted);
  }
  return false;
}

// All samples of a run of pixels. False: interrupted.
bool Renderer::State::render_batch(uint32_t first_ray, uint32_t count, const Interrupted& interrupted) {
  if (!settings.aovs.empty()) {
    const layout::RayPush push{first_ray, count, 0, 1, 1, 0, 1};
    run(passes::camera, {frame.id(), primary.rays.id()}, push, count);
    if (!trace_masked(primary, count, {.steps = true}, interrupted)) return false;
    run(passes::aov, surface_buffers(primary, {primary.rays.id(), primary.steps.id(), aovs.id()}), push,
        count, {tables.sources, tables.layered});
  }
  for (uint32_t sample = 0; sample < settings.spp; ++sample) {
    const layout::RayPush push{first_ray,
                               count,
                               sample,
                               settings.spp == 1 ? 1u : 0u,
                               has_lens() ? 0u : 1u,
                               0,
                               sample == 0 ? 1u : 0u};
    run(passes::camera, {frame.id(), primary.rays.id()}, push, count);
    if (!trace_masked(primary, count, {}, interrupted)) return false;
    if (!integrate(push, interrupted)) return false;
  }
  run(passes::resolve, {frame.id(), radiance.id(), beauty.id(), display.id()},
      layout::ResolvePush{first_ray, count}, count);
  return true;
}

Renderer::Renderer(Backend& backend, const scene::Scene& scene, const scene::Assembly& assembly,
                   const geometry_image::Atlas& atlas, const Settings& settings)
    : state_(std::make_unique<State>(backend, scene, assembly, atlas, settings)) {}

Renderer::~Renderer() = default;

std::optional<FrameResult> Renderer::render(const scene::Pose& pose, const View& view,
                                            const std::function<bool()>& interrupted) {
  State& s = *state_;
  const auto start = std::chrono::steady_clock::now();
  s.update(pose);
  s.begin_frame(pose, view);
  const uint32_t total = s.total_rays();
  for (uint32_t first = 0; first < total; first += batch_rays) {
    if (!s.render_batch(first, std::min(batch_rays, total - first), interrupted)) {
      s.backend.finish();
      return std::nullopt;
    }
  }
  FrameResult result;
  std::vector<glm::vec4> pixels(size_t(s.settings.width) * s.settings.height);
  download_all(s.backend, s.beauty, pixels);
  result.linear = make_color_image(s.settings, pixels, true);
  download_all(s.backend, s.display, pixels);
  result.display = make_color_image(s.settings, pixels, false);
  result.display.linear = false;
  if (!s.settings.aovs.empty()) {
    std::vector<glm::uvec4> quads(4 * pixels.size());
    download_all(s.backend, s.aovs, quads);
    add_aovs(s.settings, quads, result.linear);
  }
  result.passes = s.backend.finish();
  result.wall_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::vector<PassRecord> Renderer::setup_passes() const {
  return state_->setup;
}
Traversal Renderer::traversal() const {
  return state_->tracing.traversal();
}
void Renderer::update(const scene::Pose& pose) {
  state_->update(pose);
}

std::vector<glm::uvec4> Renderer::texel_map() {
  std::vector<glm::uvec4> texels(state_->atlas.texel_map.size());
  state_->backend.download(state_->texel_map(), std::as_writable_bytes(std::span(texels)), 0);
  return texels;
}

void Renderer::load_rays(const std::vector<glm::vec4>& rays) {
  State& s = *state_;
  s.loaded_rays = static_cast<uint32_t>(rays.size() / 2);
  s.loaded = RayBuffers(s.backend, "loaded_", s.loaded_rays);
  s.backend.upload(s.loaded.rays.id(), std::as_bytes(std::span(rays)));
}

void Renderer::trace_loaded() {
  State& s = *state_;
  s.tracing.trace(s.geometry, s.loaded, s.loaded_rays, {}, {});
}

std::vector<glm::uvec4> Renderer::hits() {
  std::vector<glm::uvec4> hits(state_->loaded_rays);
  download_all(state_->backend, state_->loaded.hits, hits);
  return hits;
}

const char* to_string(Integrator integrator) {
  const char* names[] = {"eye", "dof", "ao", "path"};
  return names[static_cast<uint32_t>(integrator)];
}

const char* to_string(Traversal traversal) {
  const char* names[] = {"auto", "threaded", "octant", "wide"};
  return names[static_cast<uint32_t>(traversal)];
}

}  // namespace lodestone::render
