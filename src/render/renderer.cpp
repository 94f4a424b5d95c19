// SPDX-License-Identifier: MIT
#include "lodestone/render/renderer.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/layout/camera.h"
#include "lodestone/layout/tile.h"
#include "lodestone/render/counting_backend.h"
#include "lodestone/render/film.h"
#include "lodestone/render/focus.h"
#include "lodestone/render/passes.h"
#include "lodestone/render/renderer_state.h"
#include "lodestone/render/view.h"

namespace lodestone::render {
namespace {

constexpr uint32_t most_batch_rays = 1u << 18;
constexpr uint64_t most_branches = 1u << 21;  // that wait, 48 bytes each

template <class T>
void download_all(Backend& backend, const Buffer& buffer, std::vector<T>& items) {
  backend.download(buffer.id(), std::as_writable_bytes(std::span(items)), 0);
}

bool goes_on(Integrator integrator) {
  return integrator == Integrator::specular || integrator == Integrator::glossy ||
         integrator == Integrator::path;
}

// Whether most runs of 64 rays start from one point each.
bool mostly_common_origins(const std::vector<glm::vec4>& rays) {
  const size_t run = 2 * layout::tile_rays;
  size_t runs = 0, together = 0;
  for (size_t first = 0; first < rays.size(); first += run) {
    bool equal = true;
    for (size_t i = first; i < std::min(first + run, rays.size()); i += 2)
      equal = equal && rays[i] == rays[first];
    ++runs;
    if (equal) ++together;
  }
  return 2 * together > runs;
}

}  // namespace

Renderer::State::State(Backend& device, const scene::Scene& scene_in, const scene::Assembly& assembly_in,
                       const geometry_image::Atlas& atlas_in, const Settings& settings_in)
    : backend(device),
      scene(scene_in),
      assembly(assembly_in),
      atlas(atlas_in),
      settings(settings_in),
      materials(device, scene_in, assembly_in),
      environment(device, scene_in),
      reach(scene_in),
      pose_box(scene_in) {
  check_aovs(settings.aovs);
  if (settings.progressive && settings.denoise)
    fail(ExitCode::usage, "--progressive", "does not go together with --denoise; give one of them");
  const uint32_t segments = settings.shutter_segments;
  cameras = Buffer(device, {"cameras", layout::camera_quads * (uint64_t(segments) + 1), 16});
  cut_out = Buffer(device, {"cut_out", 1, 4});
  if (settings.integrator == Integrator::path) emitter_data = render::make_emitters(scene, assembly, atlas);
  frame = Buffer(device, {"frame", 1, sizeof(layout::FrameRecord)});
  const bool splits = settings.integrator == Integrator::specular, eye = !goes_on(settings.integrator);
  if (splits && settings.max_bounces > most_specular_bounces) {
    fail(ExitCode::usage, "--max-bounces",
         "specular follows both halves of a ray that splits, at most {} times", most_specular_bounces);
  }
  const uint32_t rays = std::min(most_batch_rays, total_rays());
  const uint32_t waiting = splits ? settings.max_bounces : 0;
  // Whole tiles, so that rays that are side by side in the picture stay so.
  batch_rays = waiting == 0 ? rays : std::min<uint64_t>(rays, most_branches / waiting / 64 * 64);
  const uint64_t pixels = uint64_t(settings.width) * settings.height;
  const bool placed = assembly.has_instances();
  if (placed) {
    if (segments > 0) fail(ExitCode::usage, "--shutter", "is not for instances; give --instancing off");
    instances.emplace(device, assembly, settings.loop_budget);
  }
  primary = RayBuffers(device, "", batch_rays, placed, segments > 0);
  shadow = RayBuffers(device, "shadow_", batch_rays, placed);
  contributions = Buffer(device, {"contributions", batch_rays, 16});
  const uint32_t sums = settings.progressive ? (total_rays() + batch_rays - 1) / batch_rays : 1;
  for (uint32_t i = 0; i < sums; ++i) radiances.emplace_back(device, BufferDesc{"radiance", batch_rays, 16});
  paths = Buffer(device, {"paths", eye ? 0 : batch_rays, 16});
  const bool coned = settings.pixels_of_error > 0 && !eye;
  if (coned) cones = Buffer(device, {"cones", 2 * uint64_t(batch_rays), 16});
  branches = Buffer(device, {"branches", (coned ? 5 : 3) * uint64_t(batch_rays) * waiting, 16});
  going_on = Buffer(device, {"going_on", 1 + (eye ? 0 : uint64_t(batch_rays)), 4});
  went_on = Buffer(device, {"went_on", 1 + (eye ? 0 : uint64_t(batch_rays)), 4});
  beauty = Buffer(device, {"beauty", pixels, 16});
  display = Buffer(device, {"display", pixels, 16});
  aovs = Buffer(device, {"aovs", settings.aovs.empty() ? 0 : 4 * pixels, 16});
  if (settings.denoise) denoiser.emplace(device, settings, batch_rays);
  if (!emitter_data.empty()) emitters.emplace(device, emitter_data, batch_rays);
  make_surface();
  setup = device.finish();
}

// On the device as a whole where it fits beside all else.
void Renderer::State::make_surface() {
  const scene::Pose rest = scene::evaluate(scene, scene::none, 0);
  if (const scene::Bounds box = pose_box.of(scene, rest); !box.empty)
    scene_radius = double(glm::length(box.hi - box.lo)) / 2;
  if (settings.device_memory > 0) {
    CountingBackend counting(backend.info());
    const uint64_t bytes = [&] {
      const GeometryImage whole(counting, assembly, atlas, settings, emitter_data.first_of_charts);
      return counting.allocated_bytes();
    }();
    if (backend.allocated_bytes() + bytes > settings.device_memory) {
      if (instances) {
        fail(ExitCode::usage, "--device-memory",
             "is too little for the scene to be on the device at once, and one with instances must be; give "
             "at "
             "least {}M, or --instancing off",
             ((backend.allocated_bytes() + bytes) >> 20) + 1);
      }
      portions.emplace(backend, scene, assembly, atlas, settings, emitter_data.first_of_charts, posed(rest),
                       bytes, batch_rays, materials.has_masks);
      if (emitters) {
        emitters->place(portions->emitter_texels(emitter_data.texels));
        emitter_frame = Buffer(backend, backend.desc(frame.id()));
      }
      return;
    }
  }
  image.emplace(backend, assembly, atlas, settings, emitter_data.first_of_charts);
  if (settings.relaxation_sweeps > 0 && atlas.report.mapped_charts > 0)
    image->relax(atlas, posed(rest), scene.name);
}

// Null: nothing is tolerated.
void Renderer::State::look_from(const View* view) {
  camera = view == nullptr ? layout::RayCone{}
                           : camera_cone(*view, settings.width, settings.height, settings.pixels_of_error);
  if (image) image->set_camera(camera);
  if (portions && view != nullptr) portions->set_eye(view->origin);
}

PosedVertices Renderer::State::posed(const scene::Pose& pose) const {
  reach.check(scene, pose);
  return {scene::frame_weights(scene, assembly, pose), scene::frame_matrices(scene, assembly, pose)};
}

// Everything that follows from the pose.
void Renderer::State::update(const scene::Pose& pose, const std::vector<Moment>& shutter) {
  std::vector<PosedVertices> moments;
  std::vector<scene::Bounds> boxes;  // one an object, of each segment
  if (shutter.empty()) boxes = object_boxes(pose);
  std::vector<scene::Bounds> before;
  for (const Moment& moment : shutter) {
    moments.push_back(posed(moment.pose));
    const std::vector<scene::Bounds> now = object_boxes(moment.pose);
    for (size_t i = 0; i < before.size(); ++i) {
      boxes.push_back(before[i]);
      boxes.back().include(now[i]);
    }
    before = now;
  }
  if (portions) {
    portions->update(posed(pose), moments, boxes);
    return;
  }
  image->update(posed(pose), moments, boxes, boxes);
  if (instances)
    instances->build(scene::frame_instances(assembly, pose), boxes, image->tracing().objects(),
                     emitters ? emitters->powers() : std::vector<double>{});
}

// Round each object in its space.
std::vector<scene::Bounds> Renderer::State::object_boxes(const scene::Pose& pose) const {
  std::vector<scene::Bounds> boxes;
  for (const scene::Object& object : assembly.objects) {
    scene::Bounds& box = boxes.emplace_back();
    for (uint32_t i = 0; i < object.placements; ++i) {
      const scene::Placement& placement = assembly.placements[object.first_placement + i];
      box.include(object.rigid ? pose_box.of_mesh(placement.mesh)
                               : pose_box.of_node(scene, pose, placement.node));
    }
  }
  return boxes;
}

bool Renderer::State::trace(const RayBuffers& rays, uint32_t count, TraceQuery query,
                            const Interrupted& interrupted) {
  query.times = &times_of(rays);
  query.scattered = query.scattered && has_cones();
  query.cones = &cones;
  if (!image || instances) query.some = nullptr;  // these pass over rays by themselves
  if (instances)
    return instances->trace(image->tracing(), image->geometry(), rays, count, query, interrupted);
  if (image) return image->trace(rays, count, query, interrupted);
  return portions->trace(rays, count, query, interrupted, found_by(rays));
}

// By rays through a grid of points of the picture.
float Renderer::State::find_focus(const View& view) {
  const std::vector<glm::vec4> rays = focus_rays(view);
  const auto count = static_cast<uint32_t>(rays.size() / 2);
  const bool moves = settings.shutter_segments > 0;
  const RayBuffers probes(backend, "focus_", count, instances.has_value(), moves);
  const std::vector<float> middle(moves ? count : 0, 0.5f);
  if (moves) backend.upload(probes.times.id(), std::as_bytes(std::span(middle)));
  backend.upload(probes.rays.id(), std::as_bytes(std::span(rays)));
  trace(probes, count, {}, {});
  std::vector<glm::uvec4> hits(count);
  download_all(backend, probes.hits, hits);
  return focus_of(view, rays, hits);
}

// Of the surfaces that shine, as they are placed.
double Renderer::State::emitter_power() const {
  if (!emitters) return 0;
  if (instances) return instances->emitter_power();
  double power = 0;
  for (const double of_object : emitters->powers()) power += of_object;
  return power;
}

void Renderer::State::begin_frame(const scene::Pose& pose, const View& view,
                                  const std::vector<Moment>& shutter) {
  scene::Sky sky;
  std::vector<layout::LightRecord> records = frame_lights(scene, pose, view, sky);
  if (emitters) {
    records.emplace_back();
    records.back().kind = layout::light_emitters;
  }
  light_count = static_cast<uint32_t>(records.size());
  light_choice = choose_lights(records, {scene_radius, environment.light, emitter_power()});
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
  record.segments = settings.shutter_segments;
  record.image_texels = static_cast<uint32_t>(atlas.texel_map.size());
  record.tolerance = camera.width;
  record.tolerance_spread = camera.spread;
  record.steepest = steepest_cone(camera);
  record.environment = environment.record;
  frame_record = record;
  backend.upload(frame.id(), std::as_bytes(std::span(&record, 1)));
  if (emitter_frame) {
    record.image_texels = portions->emitter_image()->texels();
    backend.upload(emitter_frame.id(), std::as_bytes(std::span(&record, 1)));
  }
  if (record.segments > 0) upload_cameras(record, shutter);
}

// As layout/camera.h reads them. The lens stays as large as it is in the frame's middle.
void Renderer::State::upload_cameras(const layout::FrameRecord& record, const std::vector<Moment>& shutter) {
  const float radius = glm::length(record.lens_right);
  std::vector<glm::vec4> quads;
  for (const Moment& moment : shutter) {
    const View& view = moment.view;
    for (const glm::vec3& axis : {view.origin, view.right, view.up, view.forward,
                                  glm::normalize(view.right) * radius, glm::normalize(view.up) * radius})
      quads.emplace_back(axis, 0.0f);
  }
  backend.upload(cameras.id(), std::as_bytes(std::span(quads)));
}

// All rays to their end. Where materials cut out texels, hits on those are passed through until none is left;
// the nearest hit has to be found each time, also for shadow rays. False: interrupted.
bool Renderer::State::trace_masked(const RayBuffers& rays, uint32_t count, TraceQuery query,
                                   const Interrupted& interrupted) {
  query.judged = materials.has_masks;
  if (materials.has_masks) query.any_hit = false;
  if (!trace(rays, count, query, interrupted)) return false;
  if (!materials.has_masks) return true;
  query.restarted = true;
  do {
    uint32_t count_cut_out = 0;
    backend.upload(cut_out.id(), std::as_bytes(std::span(&count_cut_out, 1)));
    run(passes::mask, surface_buffers(rays, {rays.rays.id(), rays.states.id(), cut_out.id()}),
        layout::CountPush{count}, count, surface_constants(layout::recursion_none, query.scattered));
    backend.download(cut_out.id(), std::as_writable_bytes(std::span(&count_cut_out, 1)), 0);
    if (count_cut_out == 0) return true;
  } while (trace(rays, count, query, interrupted));
  return false;
}

void Renderer::State::run_camera(const layout::RayPush& push) {
  // Where nothing moves no time is written.
  run(passes::camera,
      {frame.id(), primary.rays.id(), cameras.id(),
       settings.shutter_segments > 0 ? primary.times.id() : primary.steps.id()},
      push, push.rays);
}

// Of a run of pixels, through their centres. False: interrupted.
bool Renderer::State::add_aovs(uint32_t first_ray, uint32_t count, const Interrupted& interrupted) {
  if (settings.aovs.empty()) return true;
  const bool wants_steps =
      std::find(settings.aovs.begin(), settings.aovs.end(), "steps") != settings.aovs.end();
  const layout::RayPush push{first_ray, count, 0, 1, 1, 0, 1, 0, 0, 1};
  run_camera(push);
  if (!trace_masked(primary, count, {.steps = wants_steps, .common_origin = true}, interrupted)) return false;
  run(passes::aov, surface_buffers(primary, {primary.rays.id(), primary.steps.id(), aovs.id()}), push, count,
      surface_constants());
  return true;
}

// One sample of a run of pixels. False: interrupted.
bool Renderer::State::add_sample(uint32_t first_ray, uint32_t count, uint32_t sample,
                                 const Interrupted& interrupted) {
  const layout::RayPush push{first_ray,
                             count,
                             sample,
                             settings.spp == 1 ? 1u : 0u,
                             has_lens() ? 0u : 1u,
                             0,
                             sample == 0 ? 1u : 0u,
                             0,
                             settings.max_bounces,
                             0};
  run_camera(push);
  if (!trace_masked(primary, count, {.common_origin = !has_lens()}, interrupted)) return false;
  if (denoiser)
    denoiser->add_features(surface_buffers(primary, {primary.rays.id()}), plain_constants(), count,
                           sample == 0);
  if (!integrate(push, interrupted)) return false;
  if (denoiser) denoiser->add_sample(radiance(), count, sample == 0);
  return true;
}

// What so many samples of a run of pixels have summed up to, as a picture.
void Renderer::State::resolve(uint32_t first_ray, uint32_t count, uint32_t samples) {
  if (frame_record.spp != samples) {
    frame_record.spp = samples;
    backend.upload(frame.id(), std::as_bytes(std::span(&frame_record, 1)));
  }
  run(passes::resolve, {frame.id(), radiance().id(), beauty.id(), display.id()},
      layout::ResolvePush{first_ray, count}, count);
}

// body(first_ray, count) for each run of pixels, while it says true.
template <class Body>
bool Renderer::State::for_each_batch(const Body& body) {
  const uint32_t total = total_rays();
  batch = 0;
  for (uint32_t first = 0; first < total; first += batch_rays, ++batch)
    if (!body(first, std::min(batch_rays, total - first))) return false;
  return true;
}

// All samples of one batch after the other. False: interrupted.
bool Renderer::State::render_at_once(const Interrupted& interrupted) {
  return for_each_batch([&](uint32_t first, uint32_t count) {
    if (!add_aovs(first, count, interrupted)) return false;
    for (uint32_t sample = 0; sample < settings.spp; ++sample)
      if (!add_sample(first, count, sample, interrupted)) return false;
    resolve(first, count, settings.spp);
    if (denoiser) denoiser->end_batch(frame, radiance(), first, count);
    return true;
  });
}

// Of all batches one sample after the other. How many every pixel has got: fewer than wanted where it was
// interrupted.
uint32_t Renderer::State::render_by_samples(const Interrupted& interrupted, const OnSamples& on_samples) {
  uint32_t shown = 0;  // samples that the picture has everywhere
  for (uint32_t sample = 0; sample < settings.spp; ++sample) {
    const bool done = for_each_batch([&](uint32_t first, uint32_t count) {
      return (sample > 0 || add_aovs(first, count, interrupted)) &&
             add_sample(first, count, sample, interrupted);
    });
    if (!done && sample == 0) return 0;
    const uint32_t samples = sample + 1;
    if (done && !std::has_single_bit(samples) && samples != settings.spp) continue;
    // A batch that was interrupted is in the middle of a sample, and stays as it was shown last.
    const uint32_t stopped = done ? std::numeric_limits<uint32_t>::max() : batch;
    for_each_batch([&](uint32_t first, uint32_t count) {
      if (batch != stopped) resolve(first, count, batch < stopped ? samples : sample);
      return true;
    });
    if (!done) return shown;
    shown = samples;
    if (on_samples && samples < settings.spp) on_samples(samples, [&] { return picture(samples); });
  }
  return shown;
}

// As it was resolved.
FrameResult Renderer::State::picture(uint32_t samples) {
  FrameResult result;
  result.samples = samples;
  std::vector<glm::vec4> pixels(size_t(settings.width) * settings.height);
  download_all(backend, denoiser ? denoiser->beauty() : beauty, pixels);
  result.linear = make_color_image(settings, pixels, true);
  if (denoiser && settings.noisy) {
    download_all(backend, beauty, pixels);
    add_noisy(pixels, result.linear);
  }
  download_all(backend, display, pixels);
  result.display = make_color_image(settings, pixels, false);
  result.display.linear = false;
  if (!settings.aovs.empty()) {
    std::vector<glm::uvec4> quads(4 * pixels.size());
    download_all(backend, aovs, quads);
    render::add_aovs(settings, quads, result.linear);
  }
  return result;
}

Renderer::Renderer(Backend& backend, const scene::Scene& scene, const scene::Assembly& assembly,
                   const geometry_image::Atlas& atlas, const Settings& settings)
    : state_(std::make_unique<State>(backend, scene, assembly, atlas, settings)) {}

Renderer::~Renderer() = default;

std::optional<FrameResult> Renderer::render(const scene::Pose& pose, const View& view,
                                            const std::function<bool()>& interrupted,
                                            const std::vector<Moment>& shutter, const OnSamples& on_samples) {
  State& s = *state_;
  const auto start = std::chrono::steady_clock::now();
  const uint32_t segments = s.settings.shutter_segments;
  if (shutter.size() != (segments > 0 ? segments + 1 : 0))
    fail(ExitCode::usage, "shutter", "{} moments are not the ends of {} segments", shutter.size(), segments);
  s.look_from(&view);
  s.update(pose, shutter);
  s.begin_frame(pose, view, shutter);
  uint32_t samples = s.settings.spp;
  if (s.settings.progressive) {
    samples = s.render_by_samples(interrupted, on_samples);
  } else if (!s.render_at_once(interrupted)) {
    samples = 0;
  }
  if (samples == 0) {
    s.backend.finish();
    return std::nullopt;
  }
  if (s.denoiser) s.denoiser->filter(s.frame, s.beauty, s.display);
  FrameResult result = s.picture(samples);
  result.passes = s.backend.finish();
  result.wall_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::vector<PassRecord> Renderer::setup_passes() const {
  return state_->setup;
}
std::optional<Streaming> Renderer::streaming() const {
  if (!state_->portions) return {};
  return state_->portions->streaming();
}
Traversal Renderer::traversal() const {
  return state_->image ? state_->image->tracing().traversal() : state_->portions->traversal();
}
void Renderer::update(const scene::Pose& pose, const View* view) {
  state_->look_from(view);
  state_->update(pose, {});
}

std::vector<glm::uvec4> Renderer::texel_map() {
  if (!state_->image) return state_->atlas.texel_map;
  std::vector<glm::uvec4> texels(state_->atlas.texel_map.size());
  state_->backend.download(state_->image->texel_map(), std::as_writable_bytes(std::span(texels)), 0);
  return texels;
}

void Renderer::load_rays(const std::vector<glm::vec4>& rays) {
  State& s = *state_;
  s.loaded_rays = static_cast<uint32_t>(rays.size() / 2);
  s.loaded = RayBuffers(s.backend, "loaded_", s.loaded_rays, s.instances.has_value());
  s.loaded_together = mostly_common_origins(rays);
  s.backend.upload(s.loaded.rays.id(), std::as_bytes(std::span(rays)));
}

void Renderer::trace_loaded() {
  State& s = *state_;
  s.trace(s.loaded, s.loaded_rays, {.common_origin = s.loaded_together}, {});
}

std::vector<glm::uvec4> Renderer::hits() {
  std::vector<glm::uvec4> hits(state_->loaded_rays);
  download_all(state_->backend, state_->loaded.hits, hits);
  return hits;
}

const char* to_string(Integrator integrator) {
  const char* names[] = {"eye", "dof", "ao", "specular", "glossy", "path"};
  return names[static_cast<uint32_t>(integrator)];
}

const char* to_string(Traversal traversal) {
  const char* names[] = {"auto", "threaded", "octant", "wide", "tile"};
  return names[static_cast<uint32_t>(traversal)];
}

}  // namespace lodestone::render
