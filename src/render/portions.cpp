// SPDX-License-Identifier: MIT
#include "lodestone/render/portions.h"

#include <algorithm>
#include <utility>

#include "lodestone/base/error.h"
#include "lodestone/base/parallel.h"
#include "lodestone/render/box_levels.h"
#include "lodestone/render/counting_backend.h"
#include "lodestone/render/passes.h"

namespace lodestone::render {
namespace {

constexpr uint64_t mebibyte = 1u << 20;

// How many portions are to find room side by side.
constexpr uint64_t side_by_side = 3;

Settings settings_of_portions(Settings settings) {
  if (settings.relaxation_sweeps > 0) {
    fail(ExitCode::usage, "--device-memory",
         "is too little for the scene to be on the device at once, and --relaxation-sweeps needs that; give "
         "more, or leave the sweeps");
  }
  if (settings.pixels_of_error > 0) {
    fail(ExitCode::usage, "--device-memory",
         "is too little for the scene to be on the device at once, and --pixels-of-error needs that; give "
         "more, or leave the levels of detail");
  }
  // Rays that come to a portion have been elsewhere: they do not go together as `tile` has it.
  if (settings.traversal == Traversal::automatic || settings.traversal == Traversal::tile)
    settings.traversal = Traversal::wide;
  return settings;
}

scene::Bounds intersection(const scene::Bounds& a, const scene::Bounds& b) {
  scene::Bounds both;
  both.lo = glm::max(a.lo, b.lo);
  both.hi = glm::max(both.lo, glm::min(a.hi, b.hi));
  both.empty = a.empty || b.empty;
  return both;
}

}  // namespace

FoundSurface::FoundSurface(Backend& backend, const std::string& prefix, uint64_t rays, uint32_t sources)
    : hits(backend, {prefix + "hits", rays, 16}),
      geometry(backend, {prefix + "geometry", layout::found_texels * rays, 16}),
      normal_map(backend, {prefix + "normal_map", layout::found_texels * rays, 16}),
      texel_map(backend, {prefix + "texel_map", layout::found_texels * rays, 16}),
      triangles(backend, {prefix + "triangles", sources * rays, 16}),
      positions(backend, {prefix + "positions", layout::found_vertices * sources * rays, 16}),
      normals(backend, {prefix + "normals", layout::found_vertices * sources * rays, 16}),
      tangents(backend, {prefix + "tangents", layout::found_vertices * sources * rays, 16}),
      texcoords(backend, {prefix + "texcoords", layout::found_vertices * sources * rays, 16}),
      charts(backend, {prefix + "charts", 2 * rays, 16}) {}

SurfaceBuffers FoundSurface::buffers() const {
  return {geometry.id(), normal_map.id(), texel_map.id(), triangles.id(), positions.id(),
          normals.id(),  tangents.id(),   texcoords.id(), charts.id()};
}

// A portion on the device.
struct Portions::Resident {
  Resident(Backend& backend, uint32_t number, const geometry_image::Portion& made, const Settings& settings,
           const std::vector<uint32_t>& first_emitters)
      : portion(number),
        image(backend, made.assembly, made.atlas, settings, first_emitters),
        triangle_numbers(make_buffer(backend, "triangle_numbers", 4, made.triangles)),
        run_count(static_cast<uint32_t>(made.runs.size())) {
    std::vector<geometry_image::TexelRun> ended = made.runs;
    ended.push_back({static_cast<uint32_t>(made.atlas.texel_map.size()), 0});
    runs = make_buffer(backend, "runs", 4, ended);
  }

  uint32_t portion;
  GeometryImage image;
  Buffer triangle_numbers, runs;
  uint32_t run_count;
  bool placed = false;  // where the pose has it
};

Portions::Portions(Backend& backend, const scene::Scene& scene, const scene::Assembly& assembly,
                   const geometry_image::Atlas& atlas, const Settings& settings,
                   const std::vector<uint32_t>& first_emitters, const PosedVertices& rest, uint64_t bytes,
                   uint32_t rays, bool masks)
    : backend_(backend),
      assembly_(assembly),
      atlas_(atlas),
      settings_(settings_of_portions(settings)),
      first_emitters_(first_emitters),
      sources_(sources_of(atlas)),
      found_(backend, "found_", rays, sources_),
      wanted_(backend, {"wanted", 1, 4}),
      no_runs_(backend, {"no_runs", 2, 4}),
      maker_(assembly, atlas, scene.name),
      rest_(scene::blended_positions(assembly, rest.weights, rest.matrices)) {
  reserve(rays);
  if (masks) shadow_found_ = FoundSurface(backend, "shadow_found_", rays, sources_);
  if (!first_emitters_.empty()) load_emitters();
  plan(settings, bytes);
  streaming_.portions = static_cast<uint32_t>(portions_.size());
  portion_bytes_.resize(portions_.size(), 0);
}

Portions::~Portions() = default;

void Portions::reserve(uint32_t rays) {
  if (rays <= capacity_) return;
  capacity_ = rays;
  local_ = {};
  local_ = RayBuffers(backend_, "local_", rays);
}

void Portions::load_emitters() {
  std::vector<geometry_image::ChartPiece> pieces;
  for (uint32_t c = 0; c < first_emitters_.size(); ++c) {
    const layout::ChartRecord& chart = atlas_.charts[c];
    if (first_emitters_[c] != 0) pieces.push_back({c, 0, 0, chart.width, chart.height});
  }
  const geometry_image::Portion made = maker_.make(pieces, rest_);
  const std::vector<uint32_t> first = emitters_of(pieces);
  if (const uint64_t needed = backend_.allocated_bytes() + bytes_of(made); needed > settings_.device_memory) {
    fail(ExitCode::usage, "--device-memory",
         "{} MiB are too little: pictures, rays, textures and all that shines take {}; give more, or render "
         "without --integrator path",
         settings_.device_memory / mebibyte, needed / mebibyte + 1);
  }
  emitters_ = std::make_unique<Resident>(backend_, 0, made, settings_, first);
  emitter_runs_ = made.runs;
}

// ChartRecord::first_emitter of each piece.
std::vector<uint32_t> Portions::emitters_of(const std::vector<geometry_image::ChartPiece>& pieces) const {
  std::vector<uint32_t> first;
  if (first_emitters_.empty()) return first;
  for (const geometry_image::ChartPiece& piece : pieces) {
    const uint32_t of_chart = first_emitters_[piece.chart];
    first.push_back(of_chart == 0 ? 0 : of_chart + piece.y * atlas_.charts[piece.chart].width + piece.x);
  }
  return first;
}

const GeometryImage* Portions::emitter_image() const {
  return emitters_ ? &emitters_->image : nullptr;
}

std::vector<uint32_t> Portions::emitter_texels(const std::vector<uint32_t>& texels) const {
  std::vector<uint32_t> local;
  size_t run = 0;
  for (const uint32_t texel : texels) {
    while (run + 1 < emitter_runs_.size() && emitter_runs_[run + 1].whole <= texel) ++run;
    local.push_back(texel == 0 ? 0 : emitter_runs_[run].local + (texel - emitter_runs_[run].whole));
  }
  return local;
}

// As few as can be that leave room for several.
void Portions::plan(const Settings& settings, uint64_t bytes) {
  const uint64_t fixed = backend_.allocated_bytes();
  const uint64_t left = settings.device_memory > fixed ? settings.device_memory - fixed : 0;
  double quads = double(atlas_.report.quads) * double(left) / double(side_by_side * bytes);
  for (;;) {
    portions_ = geometry_image::plan_portions(atlas_, static_cast<uint64_t>(std::max(quads, 1.0)));
    const auto size = [](const std::vector<geometry_image::ChartPiece>& pieces) {
      uint64_t all = 0;
      for (const geometry_image::ChartPiece& piece : pieces) all += piece.quads();
      return all;
    };
    const auto largest = std::max_element(portions_.begin(), portions_.end(),
                                          [&](const auto& a, const auto& b) { return size(a) < size(b); });
    const uint64_t needed = bytes_of(maker_.make(*largest, rest_));
    if (2 * needed <= left) return;
    if (quads <= double(geometry_image::least_portion)) {
      fail(ExitCode::usage, "--device-memory",
           "{} MiB are too little: pictures, rays, textures and what shines take {}, and portions of the "
           "scene {} more; "
           "give at least {}M, or render a smaller picture",
           settings.device_memory / mebibyte, fixed / mebibyte + 1, 2 * needed / mebibyte + 1,
           (fixed + 2 * needed) / mebibyte + 2);
    }
    quads = std::min(quads / 2, quads * 0.45 * double(left) / double(needed));
  }
}

uint64_t Portions::bytes_of(const geometry_image::Portion& portion) const {
  CountingBackend counting(backend_.info());
  const GeometryImage image(counting, portion.assembly, portion.atlas, settings_, {});
  return counting.allocated_bytes() + 4 * portion.triangles.size() + 8 * (portion.runs.size() + 1) + 512;
}

void Portions::update(const PosedVertices& pose, const std::vector<PosedVertices>& shutter,
                      const std::vector<scene::Bounds>& boxes) {
  if (!bounds_.empty() && pose == pose_ && shutter == shutter_) return;
  pose_ = pose;
  shutter_ = shutter;
  boxes_ = boxes;
  if (emitters_) emitters_->image.update(pose, shutter, boxes, boxes);
  for (Resident& resident : residents_) resident.placed = false;
  extent_ = 0;
  for (const scene::Bounds& box : boxes) extent_ = std::max(extent_, extent_of(box));
  const std::vector<PosedVertices> still = {pose};
  const std::vector<PosedVertices>& moments = shutter.empty() ? still : shutter;
  segments_.assign(portions_.size(), std::vector<scene::Bounds>(boxes.size()));
  for (size_t m = 0; m < moments.size(); ++m) {
    const auto positions = scene::blended_positions(assembly_, moments[m].weights, moments[m].matrices);
    parallel_for(portions_.size(), 1, [&](uint64_t begin, uint64_t end) {
      for (uint64_t p = begin; p < end; ++p) {
        const scene::Bounds at = geometry_image::portion_bounds(assembly_, atlas_, portions_[p], positions);
        if (m > 0) segments_[p][m - 1].include(at);
        if (m < boxes.size()) segments_[p][m].include(at);
      }
    });
  }
  // Texels are means of vertices, rounded. No box may reach beyond that of the whole, whose extent counts.
  const glm::vec3 slack(extent_ * 0x1p-19f);
  bounds_.assign(portions_.size(), {});
  for (size_t p = 0; p < portions_.size(); ++p) {
    for (size_t s = 0; s < boxes.size(); ++s) {
      scene::Bounds& box = segments_[p][s];
      if (!box.empty) {
        box.lo -= slack;
        box.hi += slack;
      }
      box = intersection(box, boxes[s]);
      bounds_[p].include(box);
    }
  }
}

layout::PortionPush Portions::push_of(uint32_t portion, uint32_t count, bool restarted) const {
  const scene::Bounds& box = bounds_[portion];
  return {count, restarted ? 1u : 0u, 0, 0, box.lo, extent_, box.hi};
}

void Portions::enter(const RayBuffers& rays, const layout::PortionPush& push, const TraceQuery& query,
                     const Buffer& runs) {
  run(query.shadow ? passes::occlude_portion_enter : passes::portion_enter,
      {rays.rays.id(), rays.hits.id(), rays.states.id(), runs.id(), local_.rays.id(), local_.states.id(),
       local_.hits.id(), local_.steps.id(), wanted_.id()},
      push, push.count, {0, query.steps ? 1u : 0u});
}

// Whether any ray comes near; those that do then begin there, unless they go on behind something.
bool Portions::wants(const RayBuffers& rays, const layout::PortionPush& push, const TraceQuery& query) {
  uint32_t wanted = 0;
  backend_.upload(wanted_.id(), std::as_bytes(std::span(&wanted, 1)));
  enter(rays, push, query, no_runs_);
  backend_.download(wanted_.id(), std::as_writable_bytes(std::span(&wanted, 1)), 0);
  return wanted != 0;
}

// What is there already comes first: it may have to go for the others. Of those the nearest to the camera.
std::vector<uint32_t> Portions::order() const {
  std::vector<uint32_t> order;
  std::vector<bool> there(portions_.size(), false);
  for (const Resident& resident : residents_) {
    order.push_back(resident.portion);
    there[resident.portion] = true;
  }
  const auto first = static_cast<std::ptrdiff_t>(order.size());
  std::vector<float> distance(portions_.size(), 0);
  for (uint32_t p = 0; p < portions_.size(); ++p) {
    if (there[p] || bounds_[p].empty) continue;
    distance[p] = glm::length(glm::max(glm::vec3(0), glm::max(bounds_[p].lo - eye_, eye_ - bounds_[p].hi)));
    order.push_back(p);
  }
  std::stable_sort(order.begin() + first, order.end(),
                   [&](uint32_t a, uint32_t b) { return distance[a] < distance[b]; });
  return order;
}

bool Portions::trace(const RayBuffers& rays, uint32_t count, const TraceQuery& query,
                     const Interrupted& interrupted, const FoundSurface* found) {
  reserve(count);
  const std::array<uint32_t, pass_constants> begin_constants{0, query.steps ? 1u : 0u};
  run(query.shadow ? passes::occlude_portion_begin : passes::portion_begin,
      {rays.rays.id(), rays.hits.id(), rays.states.id(), rays.steps.id(),
       found != nullptr ? found->hits.id() : local_.hits.id()},
      push_of(0, count, query.restarted), count, begin_constants);
  TraceQuery local = query;
  local.restarted = true;
  local.common_origin = false;
  for (const uint32_t portion : order()) {
    layout::PortionPush push = push_of(portion, count, query.restarted);
    if (bounds_[portion].empty || !wants(rays, push, query)) continue;
    Resident& resident = load(portion);
    if (!resident.placed) place(resident);
    push.runs = resident.run_count;
    push.image_texels = resident.image.texels();
    if (query.restarted) enter(rays, push, query, resident.runs);
    if (!resident.image.trace(local_, count, local, interrupted)) return false;
    end(rays, push, query, resident, found);
  }
  return true;
}

void Portions::end(const RayBuffers& rays, const layout::PortionPush& push, const TraceQuery& query,
                   const Resident& resident, const FoundSurface* found) {
  const FoundSurface& kept = found != nullptr ? *found : found_;  // else nothing is written there
  const SurfaceBuffers surface = resident.image.buffers();
  run(query.shadow ? passes::occlude_portion_end : passes::portion_end,
      {local_.hits.id(),
       local_.steps.id(),
       rays.hits.id(),
       rays.states.id(),
       rays.steps.id(),
       resident.runs.id(),
       settings_.shutter_segments > 0 ? query.times->id() : local_.steps.id(),
       surface.geometry,
       surface.normal_map,
       surface.texel_map,
       surface.triangles,
       resident.triangle_numbers.id(),
       surface.positions,
       surface.normals,
       surface.tangents,
       surface.texcoords,
       surface.charts,
       kept.hits.id(),
       kept.geometry.id(),
       kept.normal_map.id(),
       kept.texel_map.id(),
       kept.triangles.id(),
       kept.positions.id(),
       kept.normals.id(),
       kept.tangents.id(),
       kept.texcoords.id(),
       kept.charts.id()},
      push, push.count,
      {query.any_hit ? 1u : 0u, query.steps ? 1u : 0u, sources_, settings_.shutter_segments,
       found != nullptr ? 1u : 0u});
}

Portions::Resident& Portions::load(uint32_t portion) {
  for (Resident& resident : residents_)
    if (resident.portion == portion) return resident;
  const geometry_image::Portion made = maker_.make(portions_[portion], rest_);
  uint64_t& bytes = portion_bytes_[portion];
  if (bytes == 0) bytes = bytes_of(made);
  make_room(bytes);
  residents_.emplace_back(backend_, portion, made, settings_, emitters_of(portions_[portion]));
  ++streaming_.loads;
  streaming_.peak_bytes = std::max(streaming_.peak_bytes, backend_.allocated_bytes());
  return residents_.back();
}

// Nothing runs on the device: `wants` has waited for its answer.
void Portions::make_room(uint64_t bytes) {
  while (!residents_.empty() && backend_.allocated_bytes() + bytes > settings_.device_memory)
    residents_.pop_front();
  if (const uint64_t needed = backend_.allocated_bytes() + bytes; needed > settings_.device_memory) {
    fail(ExitCode::usage, "--device-memory",
         "{} MiB are too little for a portion of the scene; give at least {}M",
         settings_.device_memory / mebibyte, needed / mebibyte + 1);
  }
}

void Portions::place(Resident& resident) {
  resident.image.update(pose_, shutter_, segments_[resident.portion], boxes_);
  resident.placed = true;
}

}  // namespace lodestone::render
