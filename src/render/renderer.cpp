// SPDX-License-Identifier: MIT
#include "lodestone/render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/layout/frame.h"
#include "lodestone/layout/links.h"
#include "lodestone/layout/trace.h"
#include "lodestone/render/film.h"
#include "lodestone/render/focus.h"
#include "lodestone/render/hierarchy_levels.h"
#include "lodestone/render/passes.h"
#include "lodestone/render/relaxation.h"
#include "lodestone/render/scene_tables.h"
#include "lodestone/render/view.h"
#include "lodestone/scene/pose_reach.h"

namespace lodestone::render {
namespace {

constexpr uint32_t batch_rays = 1u << 18;

template <class T>
void download_all(Backend& backend, const Buffer& buffer, std::vector<T>& items) {
  backend.download(buffer.id(), std::as_writable_bytes(std::span(items)), 0);
}

// The rays of one kind (primary, or to a light) and what they found.
struct RayBuffers {
  RayBuffers() = default;
  RayBuffers(Backend& backend, const char* prefix, uint64_t count)
      : rays(backend, {std::string(prefix) + "rays", 2 * count, 16}),
        hits(backend, {std::string(prefix) + "hits", count, 16}),
        states(backend, {std::string(prefix) + "states", count, 16}),
        steps(backend, {std::string(prefix) + "steps", count, 4}) {}
  Buffer rays, hits, states, steps;
};

}  // namespace

using Interrupted = std::function<bool()>;

struct Renderer::State {
  Backend& backend;
  const scene::Scene& scene;
  const scene::Assembly& assembly;
  const geometry_image::Atlas& atlas;
  Settings settings;
  Traversal traversal;
  HierarchyLevels levels;
  SceneTables tables;
  scene::PoseReach reach;
  std::optional<Relaxation> relaxation;
  std::vector<PassRecord> setup;

  // Rewritten every frame.
  Buffer weights, matrices, positions, normals, tangents, geometry, normal_map, nodes_lo, nodes_hi,
      wide_nodes, links;
  Buffer frame, lights, pending;
  RayBuffers primary, shadow, loaded;
  uint32_t loaded_rays = 0;
  Buffer contributions, radiance, paths, beauty, display, aovs;
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

  void build_links();
  void prepare_relaxation();
  void blend(const scene::Pose& pose, const Buffer& blended_positions);
  void update(const scene::Pose& pose);
  void build_bounds();
  float find_focus(const View& view);
  void begin_frame(const scene::Pose& pose, const View& view);
  bool trace(const RayBuffers& rays, uint32_t count, bool any_hit, bool steps,
             const Interrupted& interrupted);
  bool trace_masked(const RayBuffers& rays, uint32_t count, bool any_hit, bool steps,
                    const Interrupted& interrupted);
  uint32_t take_pending();
  bool integrate(const layout::RayPush& rays, const Interrupted& interrupted);
  bool eye_sample(layout::RayPush push, const Interrupted& interrupted);
  bool ambient_sample(const layout::RayPush& rays, const Interrupted& interrupted);
  bool add_unblocked(uint32_t count, const Interrupted& interrupted);
  bool path_sample(const layout::RayPush& rays, const Interrupted& interrupted);
  bool render_batch(uint32_t first_ray, uint32_t count, const Interrupted& interrupted);
};

Renderer::State::State(Backend& device, const scene::Scene& scene_in, const scene::Assembly& assembly_in,
                       const geometry_image::Atlas& atlas_in, const Settings& settings_in)
    : backend(device),
      scene(scene_in),
      assembly(assembly_in),
      atlas(atlas_in),
      settings(settings_in),
      traversal(settings_in.traversal),
      levels(atlas_in.depth, static_cast<uint32_t>(atlas_in.leaf_map.size())),
      tables(device, scene_in, assembly_in, atlas_in),
      reach(scene_in) {
  check_aovs(settings.aovs);
  const bool cpu = device.info().kind == "cpu";
  if (traversal == Traversal::automatic) traversal = cpu ? Traversal::wide : Traversal::octant;
  if (traversal == Traversal::wide && !cpu) {
    fail(ExitCode::usage, "--traversal wide", "runs on the CPU only; use threaded or octant on this device");
  }
  const uint64_t vertices = assembly.positions.size(), texels = atlas.texel_map.size();
  weights = Buffer(device, {"weights", assembly.weight_count, 4});
  matrices = Buffer(device, {"matrices", 3 * uint64_t(assembly.matrix_count), 16});
  positions = Buffer(device, {"positions", vertices, 16});
  normals = Buffer(device, {"normals", vertices, 16});
  tangents = Buffer(device, {"tangents", vertices, 16});
  geometry = Buffer(device, {"geometry", texels, 16});
  normal_map = Buffer(device, {"normal_map", texels, 16});
  nodes_lo = Buffer(device, {"nodes_lo", levels.nodes(), 16});
  nodes_hi = Buffer(device, {"nodes_hi", levels.nodes(), 16});
  if (traversal == Traversal::wide) {
    const WideLevels wide(levels.depth(), levels.slots());
    wide_nodes = Buffer(device, {"wide_nodes", wide.end(), wide_node_bytes});
  }
  links = Buffer(device, {"links", 2 * levels.nodes(), 4});
  pending = Buffer(device, {"pending", 1, 4});
  frame = Buffer(device, {"frame", 1, sizeof(layout::FrameRecord)});
  const uint32_t rays = std::min(batch_rays, total_rays());
  const uint64_t pixels = uint64_t(settings.width) * settings.height;
  primary = RayBuffers(device, "", rays);
  shadow = RayBuffers(device, "shadow_", rays);
  contributions = Buffer(device, {"contributions", rays, 16});
  radiance = Buffer(device, {"radiance", rays, 16});
  paths = Buffer(device, {"paths", settings.integrator == Integrator::path ? rays : 0, 16});
  beauty = Buffer(device, {"beauty", pixels, 16});
  display = Buffer(device, {"display", pixels, 16});
  aovs = Buffer(device, {"aovs", settings.aovs.empty() ? 0 : 4 * pixels, 16});
  build_links();
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

void Renderer::State::build_links() {
  for (uint32_t level = 0; level <= levels.depth(); ++level) {
    // Only nodes above a slot in use: the siblings behind them are empty and never linked to.
    const uint32_t shift = 2 * (levels.depth() - level);
    const auto used = static_cast<uint32_t>((uint64_t(levels.slots()) + (uint64_t(1) << shift) - 1) >> shift);
    run(passes::links, {tables.leaf_map.id(), links.id()},
        layout::LinksPush{level, levels.depth(), used, levels.slots()}, used);
  }
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
  build_bounds();
}

void Renderer::State::build_bounds() {
  const uint32_t depth = levels.depth();
  run(passes::bounds_leaves, {tables.leaf_map.id(), geometry.id(), nodes_lo.id(), nodes_hi.id()},
      layout::BoundsPush{depth, levels.slots(), levels.places(depth), levels.places(depth - 1)},
      levels.places(depth - 1));
  for (uint32_t level = depth - 1; level > 0;) {
    const bool two = level >= 2;
    const layout::BoundsPush push{level, levels.places(level), levels.places(level - 1),
                                  two ? levels.places(level - 2) : 0};
    run(passes::bounds, {nodes_lo.id(), nodes_hi.id()}, push, two ? push.written_above : push.written);
    level -= two ? 2 : 1;
  }
  if (traversal == Traversal::wide) {
    const WideLevels wide(depth, levels.slots());
    run(passes::wide_nodes, {nodes_lo.id(), nodes_hi.id(), wide_nodes.id()},
        layout::BoundsPush{depth, levels.slots(), 0, 0}, wide.end());
  }
}

// By rays through a grid of points of the picture.
float Renderer::State::find_focus(const View& view) {
  const std::vector<glm::vec4> rays = focus_rays(view);
  const auto count = static_cast<uint32_t>(rays.size() / 2);
  const RayBuffers probes(backend, "focus_", count);
  backend.upload(probes.rays.id(), std::as_bytes(std::span(rays)));
  trace(probes, count, false, false, {});
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

uint32_t Renderer::State::take_pending() {
  uint32_t count = 0;
  backend.download(pending.id(), std::as_writable_bytes(std::span(&count, 1)), 0);
  return count;
}

// All rays to their end, in as many dispatches as the budget of each needs. False: interrupted.
bool Renderer::State::trace(const RayBuffers& rays, uint32_t count, bool any_hit, bool steps,
                            const Interrupted& interrupted) {
  const PassDecl* closest[] = {nullptr, &passes::trace_threaded, &passes::trace_octant, &passes::trace_wide};
  const PassDecl* any[] = {nullptr, &passes::occlude_threaded, &passes::occlude_octant,
                           &passes::occlude_wide};
  const bool occlusion = &rays == &shadow;
  const PassDecl& pass = *(occlusion ? any : closest)[static_cast<uint32_t>(traversal)];
  std::vector<BufferId> buffers = {rays.rays.id(),   nodes_lo.id(),   nodes_hi.id(),
                                   geometry.id(),    links.id(),      rays.hits.id(),
                                   rays.states.id(), rays.steps.id(), pending.id()};
  if (traversal == Traversal::wide) buffers.insert(buffers.end(), {wide_nodes.id(), tables.leaf_map.id()});
  const uint32_t zero = 0;
  layout::TracePush push{count, levels.depth(), take_pending() != 0 ? 1u : 0u, settings.loop_budget,
                         levels.slots()};
  do {
    if (interrupted && interrupted()) return false;
    backend.upload(pending.id(), std::as_bytes(std::span(&zero, 1)));
    run(pass, buffers, push, count, {any_hit ? 1u : 0u, steps ? 1u : 0u});
    push.resume = 1;
  } while (take_pending() != 0);
  return true;
}

// The same where materials cut out texels: hits on those are passed through until none is left. The nearest
// hit has to be found each time, also for shadow rays.
bool Renderer::State::trace_masked(const RayBuffers& rays, uint32_t count, bool any_hit, bool steps,
                                   const Interrupted& interrupted) {
  if (!trace(rays, count, any_hit && !tables.has_masks, steps, interrupted)) return false;
  if (!tables.has_masks) return true;
  do {
    run(passes::mask, surface_buffers(rays, {rays.rays.id(), rays.states.id(), pending.id()}),
        layout::CountPush{count}, count, {tables.sources});
    if (take_pending() == 0) return true;
  } while (trace(rays, count, false, steps, interrupted));
  return false;
}

// What the shadow rays carry, where nothing is in their way. False: interrupted.
bool Renderer::State::add_unblocked(uint32_t count, const Interrupted& interrupted) {
  if (!trace_masked(shadow, count, true, false, interrupted)) return false;
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
            primary, {primary.rays.id(), lights.id(), contributions.id(), shadow.rays.id(), radiance.id()}),
        push, push.rays, {tables.sources});
    if (!add_unblocked(push.rays, interrupted)) return false;
  }
  return true;
}

bool Renderer::State::ambient_sample(const layout::RayPush& rays, const Interrupted& interrupted) {
  run(passes::ambient,
      surface_buffers(primary, {primary.rays.id(), contributions.id(), shadow.rays.id(), radiance.id()}),
      layout::AmbientPush{rays.first_ray, rays.rays, rays.sample_index, rays.first, settings.ao_distance},
      rays.rays, {tables.sources});
  return add_unblocked(rays.rays, interrupted);
}

// The same by path tracing, vertex by vertex, until no path is left.
bool Renderer::State::path_sample(const layout::RayPush& rays, const Interrupted& interrupted) {
  const uint32_t zero = 0;
  for (uint32_t vertex = 0;; ++vertex) {
    const layout::PathPush push{
        rays.first_ray,       rays.rays,   rays.sample_index, vertex,
        settings.max_bounces, light_count, sky_lights,        vertex == 0 ? rays.first : 0};
    backend.upload(pending.id(), std::as_bytes(std::span(&zero, 1)));
    run(passes::path,
        surface_buffers(primary, {primary.rays.id(), lights.id(), contributions.id(), shadow.rays.id(),
                                  radiance.id(), paths.id(), pending.id()}),
        push, push.rays, {tables.sources});
    const bool last = take_pending() == 0;
    backend.upload(pending.id(), std::as_bytes(std::span(&zero, 1)));
    if (!add_unblocked(push.rays, interrupted)) return false;
    if (last) return true;
    if (!trace_masked(primary, push.rays, false, false, interrupted)) return false;
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
    if (!trace_masked(primary, count, false, true, interrupted)) return false;
    run(passes::aov, surface_buffers(primary, {primary.rays.id(), primary.steps.id(), aovs.id()}), push,
        count, {tables.sources});
  }
  for (uint32_t sample = 0; sample < settings.spp; ++sample) {
    const layout::RayPush push{
        first_ray, count, sample, settings.spp == 1 ? 1u : 0u, has_lens() ? 0u : 1u,
        0,         sample == 0 ? 1u : 0u};
    run(passes::camera, {frame.id(), primary.rays.id()}, push, count);
    if (!trace_masked(primary, count, false, false, interrupted)) return false;
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
  return state_->traversal;
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
  state_->trace(state_->loaded, state_->loaded_rays, false, false, {});
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
