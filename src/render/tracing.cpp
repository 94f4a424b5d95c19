// SPDX-License-Identifier: MIT
#include "lodestone/render/tracing.h"

#include <algorithm>
#include <iterator>

#include "lodestone/base/error.h"
#include "lodestone/layout/frame.h"
#include "lodestone/layout/links.h"
#include "lodestone/layout/tile.h"
#include "lodestone/render/box_levels.h"
#include "lodestone/render/detail.h"
#include "lodestone/render/leaf_blocks.h"
#include "lodestone/render/passes.h"
#include "lodestone/render/ray_list.h"
#include "lodestone/render/scene_tables.h"

namespace lodestone::render {
namespace {

// From how many pixels for each quad of the scene on tiles are worth it.
constexpr uint64_t pixels_a_quad = 8;

// Fewer rays are not worth finding out which have something to do, and more than this share of them not worth
// a list.
constexpr uint32_t fewest_listed = 1024;
bool is_sparse(uint32_t some, uint32_t of) {
  return 4 * uint64_t(some) <= 3 * uint64_t(of);
}

// `one_tree`: for all rays, at full resolution. `sparse`: quads are large in the picture. A tile tests all
// that its 64 rays are near to, and where many quads lie between two rays that is many times what `wide` does
// (docs/measurements.md).
Traversal choose_traversal(const DeviceInfo& device, Traversal wanted, bool one_tree, bool sparse,
                           bool detailed) {
  const bool shuffles =
      std::find(device.lacks.begin(), device.lacks.end(), "subgroup shuffles") == device.lacks.end();
  const bool tiles = device.subgroup_size == layout::tile_lanes && shuffles;
  if (wanted == Traversal::tile && !tiles) {
    fail(ExitCode::usage, "--traversal tile",
         "needs a device with subgroups of {} that can shuffle; {} has none: use wide", layout::tile_lanes,
         device.name);
  }
  if (wanted == Traversal::automatic) wanted = tiles && sparse ? Traversal::tile : Traversal::wide;
  if (wanted == Traversal::tile && !one_tree) wanted = Traversal::wide;
  if (wanted == Traversal::wide && detailed && device.kind == "cpu") wanted = Traversal::octant;
  return wanted;
}

}  // namespace

Tracing::Tracing(Backend& backend, const geometry_image::Atlas& atlas, const Buffer& leaf_map,
                 Traversal traversal, uint64_t pixels, uint32_t loop_budget, uint32_t segments,
                 const Detail* detail)
    : backend_(backend),
      leaf_map_(leaf_map),
      on_cpu_(backend.info().kind == "cpu"),
      traversal_(choose_traversal(backend.info(), traversal,
                                  atlas.objects.size() == 1 && segments == 0 && detail == nullptr,
                                  atlas.report.quads * pixels_a_quad <= pixels, detail != nullptr)),
      loop_budget_(loop_budget),
      segments_(segments),
      objects_a_segment_(static_cast<uint32_t>(atlas.objects.size())),
      image_texels_(static_cast<uint32_t>(atlas.texel_map.size())),
      detail_(detail),
      pending_(backend, {"pending", 1, 4}) {
  place_trees(atlas);
  records_.resize(trees_.size());
  objects_ = Buffer(backend, {"objects", 4 * uint64_t(trees_.size()), 16});
  if (uses_boxes()) {
    boxes_ = Buffer(backend, {"boxes", 3 * node_count_, 16});
    return;
  }
  if (traversal_ == Traversal::wide) {
    wide_nodes_ = Buffer(backend, {"wide_nodes", wide_count_, wide_node_bytes});
    return;
  }
  nodes_lo_ = Buffer(backend, {"nodes_lo", node_count_, 16});
  nodes_hi_ = Buffer(backend, {"nodes_hi", node_count_, 16});
  if (traversal_ == Traversal::threaded) {
    links_ = Buffer(backend, {"links", 2 * node_count_, 4});
    for (const Tree& tree : trees_) build_links(tree);
  }
}

// Where the hierarchy of each object begins.
void Tracing::place_trees(const geometry_image::Atlas& atlas) {
  LeafBlocks all;
  for (const geometry_image::AtlasObject& object : atlas.objects) {
    Tree tree{HierarchyLevels(object.depth, object.slots), 0, object.first_slot, 0, 0, 0, 0, 0};
    const auto leaf_map = std::span(atlas.leaf_map).subspan(object.first_slot, object.slots);
    if (traversal_ == Traversal::wide && on_cpu_) {
      const std::vector<glm::uvec4> groups = sixteen_slots(leaf_map);
      tree.first_block = static_cast<uint32_t>(all.blocks.size());
      tree.blocks = static_cast<uint32_t>(groups.size());
      all.blocks.insert(all.blocks.end(), groups.begin(), groups.end());
    } else if (uses_boxes()) {
      LeafBlocks found = find_leaf_blocks(leaf_map, tree.levels);
      if (segments_ > 0) {  // boxes_blocks bounds quads of one image
        for (const glm::uvec4& block : found.blocks) found.others.push_back(block.x);
        found.blocks.clear();
      }
      tree.first_block = static_cast<uint32_t>(all.blocks.size());
      tree.blocks = static_cast<uint32_t>(found.blocks.size());
      tree.first_group = static_cast<uint32_t>(all.others.size());
      tree.groups = static_cast<uint32_t>(found.others.size());
      all.blocks.insert(all.blocks.end(), found.blocks.begin(), found.blocks.end());
      all.others.insert(all.others.end(), found.others.begin(), found.others.end());
    }
    trees_.push_back(tree);
  }
  for (uint32_t segment = 1; segment < segments_; ++segment)
    std::copy_n(trees_.begin(), objects_a_segment_, std::back_inserter(trees_));
  for (Tree& tree : trees_) {
    tree.first_node = static_cast<uint32_t>(node_count_);
    tree.first_wide = static_cast<uint32_t>(wide_count_);
    node_count_ += uses_boxes() ? box_records(tree.levels) : tree.levels.nodes();
    wide_count_ += WideLevels(tree.levels.depth(), tree.levels.slots()).end();
  }
  leaf_blocks_ = make_buffer(backend_, "leaf_blocks", 16, all.blocks);
  leaf_groups_ = make_buffer(backend_, "leaf_groups", 4, all.others);
}

template <class Push>
void Tracing::run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push,
                  uint32_t invocations, const std::array<uint32_t, pass_constants>& constants) {
  backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), invocations, constants});
}

void Tracing::build_links(const Tree& tree) {
  const HierarchyLevels& levels = tree.levels;
  for (uint32_t level = 0; level <= levels.depth(); ++level) {
    // Only nodes above a slot in use: the siblings behind them are empty and never linked to.
    const uint32_t shift = 2 * (levels.depth() - level);
    const auto used = static_cast<uint32_t>((uint64_t(levels.slots()) + (uint64_t(1) << shift) - 1) >> shift);
    run(passes::links, {leaf_map_.id(), links_.id()},
        layout::LinksPush{level, levels.depth(), used, tree.first_node, tree.first_slot, levels.slots()},
        used);
  }
}

void Tracing::build(const Buffer& geometry, const std::vector<scene::Bounds>& boxes,
                    const std::vector<scene::Bounds>& whole, size_t first) {
  for (size_t i = first; i < trees_.size(); ++i) {
    const Tree& tree = trees_[i];
    layout::ObjectRecord& record = records_[i];
    record.first_node = tree.first_node;
    record.first_slot = tree.first_slot;
    record.first_wide = tree.first_wide;
    record.depth = tree.levels.depth();
    record.first_detail = detail_ != nullptr ? detail_->first_node(i % objects_a_segment_) : 0;
    record.slots = tree.levels.slots();
    record.lo = boxes[i].lo;
    record.hi = boxes[i].hi;
    record.step = make_grid(boxes[i]).step;
    record.extent = extent_of(whole[i]);
  }
  backend_.upload(objects_.id(), std::as_bytes(std::span(records_)));
  for (size_t i = first; i < trees_.size(); ++i) {
    if (uses_boxes()) {
      build_boxes(geometry, i);
    } else if (traversal_ == Traversal::wide) {
      build_wide_nodes(geometry, i);
    } else {
      build_nodes(geometry, i);
    }
  }
}

void Tracing::build_nodes(const Buffer& geometry, size_t object) {
  const Tree& tree = trees_[object];
  const HierarchyLevels& levels = tree.levels;
  const uint32_t image = first_texel(object);
  const uint32_t depth = levels.depth();
  const auto push_of = [&](uint32_t level, uint32_t count, uint32_t written, uint32_t written_above) {
    return layout::BoundsPush{level,           count,           written, written_above,
                              tree.first_node, tree.first_slot, image,   image + image_texels_};
  };
  run(passes::bounds_leaves, {leaf_map_.id(), geometry.id(), nodes_lo_.id(), nodes_hi_.id()},
      push_of(depth, levels.slots(), levels.places(depth), levels.places(depth - 1)),
      levels.places(depth - 1), {segments_ > 0 ? 1u : 0u});
  for (uint32_t level = depth - 1; level > 0;) {
    const bool two = level >= 2;
    const layout::BoundsPush push =
        push_of(level, levels.places(level), levels.places(level - 1), two ? levels.places(level - 2) : 0);
    run(passes::bounds, {nodes_lo_.id(), nodes_hi_.id()}, push, two ? push.written_above : push.written);
    level -= two ? 2 : 1;
  }
}

void Tracing::build_wide_nodes(const Buffer& geometry, size_t object) {
  const Tree& tree = trees_[object];
  const uint32_t image = first_texel(object);
  const layout::BoxesPush push{tree.levels.depth(),
                               tree.levels.slots(),
                               0,
                               0,
                               layout::object_grid(records_[object]),
                               tree.first_wide,
                               tree.first_slot,
                               tree.first_block,
                               image,
                               image + image_texels_};
  run(passes::wide_nodes, {leaf_map_.id(), geometry.id(), leaf_blocks_.id(), wide_nodes_.id()}, push,
      tree.blocks, {segments_ > 0 ? 1u : 0u});
}

void Tracing::build_boxes(const Buffer& geometry, size_t object) {
  const Tree& tree = trees_[object];
  const uint32_t image = first_texel(object);
  const layout::BoxGrid grid = layout::object_grid(records_[object]);
  // Two levels a dispatch; level `depth` are the quads.
  const uint32_t depth = tree.levels.depth();
  const auto written = [&](uint32_t level) { return level > 0 ? tree.levels.places(level - 1) : 0; };
  const auto push_of = [&](uint32_t level, uint32_t count, uint32_t above, uint32_t first_item) {
    return layout::BoxesPush{level,           count,           written(level), above, grid,
                             tree.first_node, tree.first_slot, first_item,     image, image + image_texels_};
  };
  if (tree.blocks > 0) {
    run(passes::boxes_blocks, {leaf_blocks_.id(), geometry.id(), boxes_.id()},
        push_of(depth, tree.blocks, 0, tree.first_block), tree.blocks);
  }
  if (tree.groups > 0 || depth == 1) {
    run(passes::boxes_leaves, {leaf_map_.id(), geometry.id(), boxes_.id(), leaf_groups_.id()},
        push_of(depth, tree.levels.slots(), tree.groups, tree.first_group),
        depth == 1 ? written(depth) : tree.groups, {segments_ > 0 ? 1u : 0u});
  }
  for (uint32_t level = depth - 2; depth > 2 && level > 0;) {
    const bool two = level >= 2;
    const layout::BoxesPush push = push_of(level, tree.levels.places(level), two ? written(level - 1) : 0, 0);
    run(passes::boxes, {boxes_.id()}, push, two ? push.written_above : push.written);
    level -= two ? 2 : 1;
  }
}

void Tracing::clear_pending() {
  const uint32_t zero = 0;
  backend_.upload(pending_.id(), std::as_bytes(std::span(&zero, 1)));
}

uint32_t Tracing::take_pending() {
  uint32_t count = 0;
  backend_.download(pending_.id(), std::as_writable_bytes(std::span(&count, 1)), 0);
  return count;
}

std::optional<uint32_t> Tracing::list_rays(const RayBuffers& rays, uint32_t count, const Round& round,
                                           const TraceQuery& query, std::optional<uint32_t> waiting) {
  if (waiting && !is_sparse(*waiting, count)) return {};
  const RayListing listing{query.shadow ? passes::occlude_list : passes::list_rays,
                           query.shadow ? passes::occlude_scan : passes::scan_blocks,
                           rays,
                           count,
                           query.some,
                           rays.list,
                           round.resume,
                           round.resumable};
  listing.find(backend_);
  if (!waiting) {
    waiting = listing.found(backend_);
    if (!is_sparse(*waiting, count)) return {};
  }
  listing.place(backend_);
  return waiting;
}

void Tracing::dispatch(const Buffer& geometry, const RayBuffers& rays, uint32_t count, const Buffer* list,
                       const TraceQuery& query, const Round& round, const Buffer* roots) {
  std::vector<BufferId> buffers = {rays.rays.id(),   geometry.id(),   rays.hits.id(),
                                   rays.states.id(), rays.steps.id(), pending_.id()};
  const std::array<uint32_t, pass_constants> constants{
      query.any_hit ? 1u : 0u,      query.steps ? 1u : 0u,    roots != nullptr ? 1u : 0u, segments_,
      detail_ != nullptr ? 1u : 0u, round.resumable ? 1u : 0u};
  const bool scattered = detail_ != nullptr && query.scattered;
  layout::TracePush push{count,
                         round.resume,
                         loop_budget_,
                         image_texels_,
                         objects_a_segment_,
                         scattered ? 1u : 0u,
                         camera_.apex,
                         camera_.width,
                         camera_.spread,
                         list != nullptr ? 1u : 0u};
  // What the constants leave out nothing reads; any words and quads will do.
  std::vector<BufferId> of_objects = {objects_.id(), roots != nullptr ? roots->id() : rays.steps.id(),
                                      segments_ > 0 ? query.times->id() : rays.steps.id()};
  if (detail_ != nullptr) {
    of_objects.insert(of_objects.end(),
                      {detail_->collapses().id(), detail_->node_details().id(), detail_->coarse_quads().id(),
                       scattered ? query.cones->id() : geometry.id()});
  } else {
    of_objects.insert(of_objects.end(), {rays.steps.id(), geometry.id(), geometry.id(), geometry.id()});
  }
  of_objects.push_back(list != nullptr ? list->id() : rays.steps.id());
  if (uses_boxes()) {
    buffers.insert(buffers.end(), {boxes_.id(), leaf_map_.id(), rays.trails.id()});
    buffers.insert(buffers.end(), of_objects.begin(), of_objects.end());
    push.budget =
        (loop_budget_ + 1) / 2;  // its loops have up to twice as many iterations a step as the others'
    run(query.shadow ? passes::occlude_boxes : passes::trace_boxes, buffers, push, count, constants);
    return;
  }
  if (traversal_ == Traversal::wide) {
    buffers.insert(buffers.end(), {wide_nodes_.id(), leaf_map_.id()});
    buffers.insert(buffers.end(), of_objects.begin(), of_objects.end());
    run(query.shadow ? passes::occlude_wide : passes::trace_wide, buffers, push, count, constants);
    return;
  }
  buffers.insert(buffers.end(), {nodes_lo_.id(), nodes_hi_.id()});
  if (traversal_ == Traversal::octant) {
    buffers.insert(buffers.end(), of_objects.begin(), of_objects.end());
    run(query.shadow ? passes::occlude_octant : passes::trace_octant, buffers, push, count, constants);
  } else {
    buffers.push_back(links_.id());
    buffers.insert(buffers.end(), of_objects.begin(), of_objects.end());
    run(query.shadow ? passes::occlude_threaded : passes::trace_threaded, buffers, push, count, constants);
  }
}

void Tracing::dispatch_tiles(const Buffer& geometry, const RayBuffers& rays, uint32_t count,
                             const Round& round) {
  const uint32_t tiles = (count + layout::tile_rays - 1) / layout::tile_rays;
  layout::TracePush push{};
  push.rays = count;
  push.budget = loop_budget_;
  run(passes::trace_tile,
      {rays.rays.id(), geometry.id(), rays.hits.id(), rays.states.id(), rays.steps.id(), pending_.id(),
       boxes_.id(), leaf_map_.id(), objects_.id(), rays.steps.id(), rays.steps.id(), rays.steps.id(),
       geometry.id(), geometry.id(), geometry.id(), rays.steps.id()},
      push, tiles * layout::tile_lanes, {0, 0, 0, 0, 0, round.resumable ? 1u : 0u});
}

bool Tracing::trace(const Buffer& geometry, const RayBuffers& rays, uint32_t count, const TraceQuery& query,
                    const Interrupted& interrupted, const Buffer* roots) {
  const bool tiles = traversal_ == Traversal::tile && query.common_origin && !query.any_hit && !query.steps;
  // Most rays come to their end in the first dispatch, which need not keep what only the next ones read.
  Round round{query.restarted ? layout::resume_states : layout::resume_nothing,
              query.restarted || query.judged || query.steps};
  // The CPU passes over rays by itself, and rays through instances lie side by side already.
  const Buffer* some = on_cpu_ ? nullptr : query.some;
  const uint32_t all = some != nullptr ? query.some_count : count;
  const bool lists = !on_cpu_ && roots == nullptr && !query.steps && all >= fewest_listed;
  std::optional<uint32_t> waiting;
  // The camera's are all there, and so are those of a list.
  if (!query.restarted && (query.common_origin || (some != nullptr && !query.shadow))) waiting = all;
  do {
    if (interrupted && interrupted()) return false;
    clear_pending();
    if (tiles && round.resume == layout::resume_nothing) {
      dispatch_tiles(geometry, rays, count, round);  // what does not go together is left to the next
    } else {
      std::optional<uint32_t> listed;
      if (lists) listed = list_rays(rays, all, round, query, waiting);
      const Buffer* list = listed ? &rays.list : some;
      if (listed != 0u) dispatch(geometry, rays, listed.value_or(all), list, query, round, roots);
    }
    round = {round.resumable ? layout::resume_states : layout::resume_unanswered, true};
    waiting = take_pending();
  } while (waiting != 0u);
  return true;
}

}  // namespace lodestone::render
