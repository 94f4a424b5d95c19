// SPDX-License-Identifier: MIT
#include "lodestone/render/instances.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lodestone/geometry_image/slots.h"
#include "lodestone/layout/frame.h"
#include "lodestone/layout/objects.h"
#include "lodestone/render/box_levels.h"
#include "lodestone/render/number_shares.h"
#include "lodestone/render/passes.h"

namespace lodestone::render {
namespace {

// The largest sum of absolute values of a row.
double row_norm(const glm::dmat3& m) {
  double largest = 0;
  for (glm::length_t row = 0; row < 3; ++row)
    largest = std::max(largest, std::abs(m[0][row]) + std::abs(m[1][row]) + std::abs(m[2][row]));
  return largest;
}

void store_rows(const glm::dmat4& m, glm::vec4 (&rows)[3]) {
  for (glm::length_t row = 0; row < 3; ++row) {
    for (glm::length_t column = 0; column < 4; ++column)
      rows[row][column] = layout::flush_tiny(static_cast<float>(m[column][row]));
  }
}

layout::InstanceRecord make_record(const scene::Instance& instance, const glm::mat4& matrix) {
  layout::InstanceRecord record{};
  record.object = instance.object;
  record.node = instance.node == scene::none ? layout::no_index : instance.node;
  const glm::dmat4 to_world(matrix);
  store_rows(to_world, record.to_world);
  const glm::dmat3 linear(to_world);
  const double edges = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  record.rounding = -1;
  // Flatter than this, rounding is larger than the surface.
  if (!std::isfinite(edges) || !(std::abs(glm::determinant(linear)) > edges * 0x1p-20)) return record;
  const glm::dmat4 to_object = glm::inverse(to_world);
  store_rows(to_object, record.to_object);
  const double growth = row_norm(linear) * row_norm(glm::dmat3(to_object));
  // One in the world already is as exact as without instances.
  record.rounding = instance.node == scene::none ? 1.0f : static_cast<float>(1 + growth);
  return record;
}

scene::Bounds world_box(const scene::Bounds& box, const glm::mat4& m) {
  scene::Bounds result;
  const glm::vec3 middle = 0.5f * (box.lo + box.hi), half = 0.5f * (box.hi - box.lo);
  const glm::vec3 center(m * glm::vec4(middle, 1));
  const glm::vec3 reach = glm::abs(glm::vec3(m[0])) * half.x + glm::abs(glm::vec3(m[1])) * half.y +
                          glm::abs(glm::vec3(m[2])) * half.z;
  result.include(center - reach);
  result.include(center + reach);
  return result;
}

// One a kind of ray, so that statistics tell them apart.
struct EnterPasses {
  const PassDecl &enter, &scan, &gather, &local;
};
EnterPasses enter_passes(bool shadow) {
  if (shadow)
    return {passes::occlude_enter, passes::occlude_scan, passes::occlude_gather, passes::occlude_local};
  return {passes::enter_instances, passes::scan_blocks, passes::gather_rays, passes::local_rays};
}

}  // namespace

Instances::Instances(Backend& backend, const scene::Assembly& assembly, uint32_t loop_budget)
    : backend_(backend),
      assembly_(assembly),
      count_(static_cast<uint32_t>(assembly.instances.size())),
      loop_budget_(loop_budget),
      levels_(geometry_image::tree_depth(count_), count_),
      records_(backend, {"instances", layout::instance_quads * uint64_t(count_), 16}),
      numbers_(backend, {"instance_numbers", count_, 4}),
      lo_(backend, {"instance_lo", count_, 16}),
      hi_(backend, {"instance_hi", count_, 16}),
      keys_(backend, {"keys", 2 * uint64_t(count_), 4}),
      sorted_(backend, {"sorted", 2 * uint64_t(count_), 4}),
      boxes_(backend, {"upper_boxes", 3 * box_records(levels_), 16}),
      entered_(backend, {"entered", 1, 4}) {}

template <class Push>
void Instances::run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push,
                    uint32_t invocations, const std::array<uint32_t, pass_constants>& constants) {
  backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), invocations, constants});
}

void Instances::build(const std::vector<glm::mat4>& matrices, const std::vector<scene::Bounds>& boxes,
                      const Buffer& objects, const std::vector<double>& powers) {
  std::vector<layout::InstanceRecord> records;
  scene::Bounds world;
  rounding_ = 1;
  for (size_t i = 0; i < count_; ++i) {
    const scene::Instance& instance = assembly_.instances[i];
    records.push_back(make_record(instance, matrices[i]));
    if (records.back().rounding < 0 || boxes[instance.object].empty) continue;
    rounding_ = std::max(rounding_, records.back().rounding);
    world.include(world_box(boxes[instance.object], matrices[i]));
  }
  if (!powers.empty()) share_out_emitters(records, powers);
  backend_.upload(records_.id(), std::as_bytes(std::span(records)));
  // Bounds are rounded outwards a little more than this box.
  extent_ = extent_of(world) * (1 + 0x1p-13f);
  world.lo -= extent_ * 0x1p-13f;
  world.hi += extent_ * 0x1p-13f;
  grid_ = make_grid(world);
  layout::PlacePush push{count_, world.lo, glm::vec3(0)};
  for (glm::length_t axis = 0; axis < 3; ++axis) push.per_step[axis] = 1 / (64 * grid_.step[axis]);
  run(passes::place_instances, {objects.id(), records_.id(), lo_.id(), hi_.id(), keys_.id()}, push, count_);
  sort();
  build_tree();
}

// By the power of the object and by how much larger the instance is.
void Instances::share_out_emitters(std::vector<layout::InstanceRecord>& records,
                                   const std::vector<double>& powers) {
  std::vector<double> weights;
  emitter_power_ = 0;
  for (const layout::InstanceRecord& record : records) {
    glm::dmat3 linear;
    for (glm::length_t row = 0; row < 3; ++row) linear[row] = glm::dvec3(record.to_world[row]);
    const double scale = std::cbrt(std::abs(glm::determinant(linear)));
    const double weight = record.rounding < 0 ? 0 : powers[record.object] * scale * scale;
    weights.push_back(std::isfinite(weight) ? weight : 0);
    emitter_power_ += weights.back();
  }
  std::vector<uint32_t> first(records.size() + 1);
  share_out(weights, first);
  for (size_t i = 0; i < records.size(); ++i)
    records[i].emitter_share = weights[i] > 0 ? first[i + 1] - first[i] : 0;
  backend_.upload(numbers_.id(), std::as_bytes(std::span(first)).first(4 * records.size()));
}

// keys_ becomes sorted.
void Instances::sort() {
  for (uint64_t length = 0; length < count_; length = length == 0 ? layout::sort_run : 2 * length) {
    run(passes::sort_keys, {keys_.id(), sorted_.id()},
        layout::SortPush{count_, static_cast<uint32_t>(length)}, count_);
    std::swap(keys_, sorted_);
  }
}

void Instances::build_tree() {
  const uint32_t depth = levels_.depth();
  const auto written = [&](uint32_t level) { return level > 0 ? levels_.places(level - 1) : 0; };
  run(passes::upper_leaves, {keys_.id(), lo_.id(), hi_.id(), boxes_.id()},
      layout::BoxesPush{depth, count_, written(depth), 0, grid_, 0, 0, 0, 0, 0}, written(depth));
  for (uint32_t level = depth - 1; level > 0;) {
    const bool two = level >= 2;
    const layout::BoxesPush push{
        level, levels_.places(level), written(level), two ? written(level - 1) : 0, grid_, 0, 0, 0, 0, 0};
    run(passes::upper_boxes, {boxes_.id()}, push, two ? push.written_above : push.written);
    level -= two ? 2 : 1;
  }
}

void Instances::reserve(uint32_t rays) {
  if (rays <= capacity_) return;
  capacity_ = rays;
  const uint64_t blocks = most_list_blocks(rays);
  local_ = RayBuffers(backend_, "local_", rays);
  owners_ = Buffer(backend_, {"owners", rays, 4});
  next_owners_ = Buffer(backend_, {"next_owners", rays, 4});
  roots_ = Buffer(backend_, {"roots", rays, 4});
  found_ = Buffer(backend_, {"found", rays, 4});
  block_counts_ = Buffer(backend_, {"block_counts", blocks, 4});
  block_starts_ = Buffer(backend_, {"block_starts", blocks, 4});
}

// How many of `count` rays have entered an instance.
uint32_t Instances::enter(const RayBuffers& rays, uint32_t count, uint32_t round, const TraceQuery& query) {
  const EnterPasses passes = enter_passes(query.shadow);
  const layout::ListPush list{count, layout::list_block(count)};
  const uint32_t blocks = list_blocks(list);
  const std::array<uint32_t, pass_constants> constants{query.any_hit ? 1u : 0u, query.steps ? 1u : 0u};
  run(passes.enter,
      {rays.rays.id(), rays.hits.id(), rays.instances.id(), rays.states.id(), rays.places.id(),
       rays.trails.id(), rays.steps.id(), boxes_.id(), keys_.id(), lo_.id(), hi_.id(), owners_.id(),
       local_.hits.id(), local_.steps.id(), found_.id(), block_counts_.id()},
      layout::EnterPush{count, round, query.restarted ? 1u : 0u, levels_.depth(), (loop_budget_ + 1) / 2,
                        extent_, rounding_, list.block, grid_},
      count, constants);
  run(passes.scan, {block_counts_.id(), block_starts_.id(), entered_.id()}, layout::CountPush{blocks}, 1);
  uint32_t entered = 0;
  backend_.download(entered_.id(), std::as_writable_bytes(std::span(&entered, 1)), 0);
  if (entered == 0) return 0;
  run(passes.gather, {found_.id(), block_starts_.id(), owners_.id(), next_owners_.id()},
      layout::GatherPush{count, round, list.block}, blocks);
  std::swap(owners_, next_owners_);
  run(passes.local,
      {rays.rays.id(), rays.hits.id(), rays.states.id(), rays.places.id(), found_.id(), records_.id(),
       owners_.id(), roots_.id(), local_.rays.id(), local_.states.id(), local_.steps.id()},
      layout::CountPush{entered}, entered, constants);
  return entered;
}

bool Instances::trace(Tracing& tracing, const Buffer& geometry, const RayBuffers& rays, uint32_t count,
                      const TraceQuery& query, const Interrupted& interrupted) {
  reserve(count);
  TraceQuery local = query;
  local.common_origin = false;
  for (uint32_t round = 0; count > 0; round = 1) {
    count = enter(rays, count, round, query);
    if (count > 0 && !tracing.trace(geometry, local_, count, local, interrupted, &roots_)) return false;
  }
  return true;
}

}  // namespace lodestone::render
