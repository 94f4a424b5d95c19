// SPDX-License-Identifier: MIT
#include "lodestone/render/tracing.h"

#include <algorithm>

#include "lodestone/base/error.h"
#include "lodestone/layout/frame.h"
#include "lodestone/layout/links.h"
#include "lodestone/layout/tile.h"
#include "lodestone/layout/trace.h"
#include "lodestone/render/leaf_blocks.h"
#include "lodestone/render/passes.h"
#include "lodestone/render/scene_tables.h"

namespace lodestone::render {
namespace {

Traversal choose_traversal(const DeviceInfo& device, Traversal wanted) {
  const bool shuffles =
      std::find(device.lacks.begin(), device.lacks.end(), "subgroup shuffles") == device.lacks.end();
  const bool tiles = device.subgroup_size == layout::tile_lanes && shuffles;
  if (wanted == Traversal::tile && !tiles) {
    fail(ExitCode::usage, "--traversal tile",
         "needs a device with subgroups of {} that can shuffle; {} has none: use wide", layout::tile_lanes,
         device.name);
  }
  if (wanted == Traversal::automatic) return tiles ? Traversal::tile : Traversal::wide;
  return wanted;
}

// A flat axis gets a thousandth of the largest one. Rounded outwards, all planes stay below 65535.
layout::BoxGrid make_grid(const scene::Bounds& frame) {
  const glm::vec3 size = frame.hi - frame.lo;
  const float largest = std::max(layout::max_component(size), 1e-30f);
  layout::BoxGrid grid{};
  grid.base = frame.lo;
  for (int axis = 0; axis < 3; ++axis)
    grid.step[axis] = std::max(size[axis], largest * 0x1p-10f) * (1.0f / 65000);
  return grid;
}

}  // namespace

Tracing::Tracing(Backend& backend, const geometry_image::Atlas& atlas, const Buffer& leaf_map,
                 Traversal traversal, uint32_t loop_budget)
    : backend_(backend),
      leaf_map_(leaf_map),
      on_cpu_(backend.info().kind == "cpu"),
      traversal_(choose_traversal(backend.info(), traversal)),
      loop_budget_(loop_budget),
      levels_(atlas.depth, static_cast<uint32_t>(atlas.leaf_map.size())),
      pending_(backend, {"pending", 1, 4}) {
  if (uses_boxes()) {
    // Blocks of slots write four records each, also those past the last slot.
    const uint32_t depth = levels_.depth();
    const uint64_t last_level = depth >= 2 ? 4 * uint64_t(levels_.places(depth - 2)) : 1;
    const uint64_t records = layout::level_base(depth - 1) + last_level;
    boxes_ = Buffer(backend, {"boxes", 3 * records, 16});
    extent_ = Buffer(backend, {"extent", 1, 4});
    const LeafBlocks found = find_leaf_blocks(atlas.leaf_map, levels_);
    block_count_ = static_cast<uint32_t>(found.blocks.size());
    group_count_ = static_cast<uint32_t>(found.others.size());
    leaf_blocks_ = make_buffer(backend, "leaf_blocks", 16, found.blocks);
    leaf_groups_ = make_buffer(backend, "leaf_groups", 4, found.others);
    return;
  }
  nodes_lo_ = Buffer(backend, {"nodes_lo", levels_.nodes(), 16});
  nodes_hi_ = Buffer(backend, {"nodes_hi", levels_.nodes(), 16});
  if (traversal_ == Traversal::threaded) {
    links_ = Buffer(backend, {"links", 2 * levels_.nodes(), 4});
    build_links();
  } else if (traversal_ == Traversal::wide) {
    const WideLevels wide(levels_.depth(), levels_.slots());
    wide_nodes_ = Buffer(backend, {"wide_nodes", wide.end(), wide_node_bytes});
  }
}

template <class Push>
void Tracing::run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push,
                  uint32_t invocations, const std::array<uint32_t, pass_constants>& constants) {
  backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), invocations, constants});
}

void Tracing::build_links() {
  for (uint32_t level = 0; level <= levels_.depth(); ++level) {
    // Only nodes above a slot in use: the siblings behind them are empty and never linked to.
    const uint32_t shift = 2 * (levels_.depth() - level);
    const auto used =
        static_cast<uint32_t>((uint64_t(levels_.slots()) + (uint64_t(1) << shift) - 1) >> shift);
    run(passes::links, {leaf_map_.id(), links_.id()},
        layout::LinksPush{level, levels_.depth(), used, levels_.slots()}, used);
  }
}

void Tracing::build(const Buffer& geometry, const scene::Bounds& frame) {
  if (uses_boxes()) {
    build_boxes(geometry, frame);
  } else {
    build_nodes(geometry);
  }
}

void Tracing::build_nodes(const Buffer& geometry) {
  const uint32_t depth = levels_.depth();
  run(passes::bounds_leaves, {leaf_map_.id(), geometry.id(), nodes_lo_.id(), nodes_hi_.id()},
      layout::BoundsPush{depth, levels_.slots(), levels_.places(depth), levels_.places(depth - 1)},
      levels_.places(depth - 1));
  for (uint32_t level = depth - 1; level > 0;) {
    const bool two = level >= 2;
    const layout::BoundsPush push{level, levels_.places(level), levels_.places(level - 1),
                                  two ? levels_.places(level - 2) : 0};
    run(passes::bounds, {nodes_lo_.id(), nodes_hi_.id()}, push, two ? push.written_above : push.written);
    level -= two ? 2 : 1;
  }
  if (traversal_ == Traversal::wide) {
    const WideLevels wide(depth, levels_.slots());
    run(passes::wide_nodes, {nodes_lo_.id(), nodes_hi_.id(), wide_nodes_.id()},
        layout::BoundsPush{depth, levels_.slots(), 0, 0}, wide.end());
  }
}

void Tracing::build_boxes(const Buffer& geometry, const scene::Bounds& frame) {
  grid_ = make_grid(frame);
  const uint32_t zero = 0;
  backend_.upload(extent_.id(), std::as_bytes(std::span(&zero, 1)));
  // Two levels a dispatch; level `depth` are the quads.
  const uint32_t depth = levels_.depth();
  const auto written = [&](uint32_t level) { return level > 0 ? levels_.places(level - 1) : 0; };
  if (block_count_ > 0) {
    run(passes::boxes_blocks, {leaf_blocks_.id(), geometry.id(), boxes_.id(), extent_.id()},
        layout::BoxesPush{depth, block_count_, written(depth), 0, grid_}, block_count_);
  }
  if (group_count_ > 0 || depth == 1) {
    run(passes::boxes_leaves, {leaf_map_.id(), geometry.id(), boxes_.id(), extent_.id(), leaf_groups_.id()},
        layout::BoxesPush{depth, levels_.slots(), written(depth), group_count_, grid_},
        depth == 1 ? written(depth) : group_count_);
  }
  for (uint32_t level = depth - 2; depth > 2 && level > 0;) {
    const bool two = level >= 2;
    const layout::BoxesPush push{level, levels_.places(level), written(level), two ? written(level - 1) : 0,
                                 grid_};
    run(passes::boxes, {boxes_.id()}, push, two ? push.written_above : push.written);
    level -= two ? 2 : 1;
  }
}

uint32_t Tracing::take_pending() {
  uint32_t count = 0;
  backend_.download(pending_.id(), std::as_writable_bytes(std::span(&count, 1)), 0);
  return count;
}

void Tracing::dispatch(const Buffer& geometry, const RayBuffers& rays, uint32_t count,
                       const TraceQuery& query, bool resume) {
  std::vector<BufferId> buffers = {rays.rays.id(),   geometry.id(),   rays.hits.id(),
                                   rays.states.id(), rays.steps.id(), pending_.id()};
  const std::array<uint32_t, pass_constants> constants{query.any_hit ? 1u : 0u, query.steps ? 1u : 0u};
  const layout::TracePush push{count, levels_.depth(), resume ? 1u : 0u, loop_budget_, levels_.slots()};
  if (uses_boxes()) {
    buffers.insert(buffers.end(), {boxes_.id(), leaf_map_.id(), extent_.id(), rays.trails.id()});
    // Its loops have up to twice as many iterations a step as the others'.
    run(query.shadow ? passes::occlude_boxes : passes::trace_boxes, buffers,
        layout::BoxTracePush{count, push.depth, push.resume, (loop_budget_ + 1) / 2, grid_}, count,
        constants);
    return;
  }
  buffers.insert(buffers.end(), {nodes_lo_.id(), nodes_hi_.id()});
  if (traversal_ == Traversal::wide) {
    buffers.insert(buffers.end(), {wide_nodes_.id(), leaf_map_.id()});
    run(query.shadow ? passes::occlude_wide : passes::trace_wide, buffers, push, count, constants);
  } else if (traversal_ == Traversal::octant) {
    run(query.shadow ? passes::occlude_octant : passes::trace_octant, buffers, push, count, constants);
  } else {
    buffers.push_back(links_.id());
    run(query.shadow ? passes::occlude_threaded : passes::trace_threaded, buffers, push, count, constants);
  }
}

void Tracing::dispatch_tiles(const Buffer& geometry, const RayBuffers& rays, uint32_t count) {
  const uint32_t tiles = (count + layout::tile_rays - 1) / layout::tile_rays;
  run(passes::trace_tile,
      {rays.rays.id(), geometry.id(), rays.hits.id(), rays.states.id(), rays.steps.id(), pending_.id(),
       boxes_.id(), leaf_map_.id(), extent_.id()},
      layout::BoxTracePush{count, levels_.depth(), 0, loop_budget_, grid_}, tiles * layout::tile_lanes);
}

bool Tracing::trace(const Buffer& geometry, const RayBuffers& rays, uint32_t count, const TraceQuery& query,
                    const Interrupted& interrupted) {
  const uint32_t zero = 0;
  const bool tiles = traversal_ == Traversal::tile && query.common_origin && !query.any_hit && !query.steps;
  bool resume = take_pending() != 0;
  do {
    if (interrupted && interrupted()) return false;
    backend_.upload(pending_.id(), std::as_bytes(std::span(&zero, 1)));
    if (tiles && !resume) {
      dispatch_tiles(geometry, rays, count);  // what does not go together is left to the next dispatch
    } else {
      dispatch(geometry, rays, count, query, resume);
    }
    resume = true;
  } while (take_pending() != 0);
  return true;
}

}  // namespace lodestone::render
