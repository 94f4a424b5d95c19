// SPDX-License-Identifier: MIT
// The hierarchy over the geometry image, built every frame, and rays traced through it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/layout/detail.h"
#include "lodestone/layout/objects.h"
#include "lodestone/layout/ray_list.h"
#include "lodestone/render/backend.h"
#include "lodestone/render/hierarchy_levels.h"
#include "lodestone/render/renderer.h"
#include "lodestone/scene/pose.h"

namespace lodestone::render {

using Interrupted = std::function<bool()>;

// The blocks of a list of so many rays (layout/ray_list.h), and of any list of no more.
inline uint32_t list_blocks(const layout::ListPush& push) {
  return push.count == 0 ? 0 : (push.count - 1) / push.block + 1;
}
inline uint64_t most_list_blocks(uint64_t count) {
  return std::min<uint64_t>((count + layout::fewest_in_block - 1) / layout::fewest_in_block,
                            layout::most_blocks);
}

// The rays of one kind (primary, or to a light), two quads each as layout/ray.h has them, and what they
// found.
struct RayBuffers {
  RayBuffers() = default;
  // `placed`: for rays through instances; `timed`: for rays through what moves.
  RayBuffers(Backend& backend, const std::string& prefix, uint64_t count, bool placed = false,
             bool timed = false)
      : rays(backend, {prefix + "rays", 2 * count, 16}),
        hits(backend, {prefix + "hits", count, 16}),
        states(backend, {prefix + "states", count, 16}),
        trails(backend, {prefix + "trails", count, 16}),
        steps(backend, {prefix + "steps", count, 4}),
        list(backend, {prefix + "list", count + 1, 4}),
        block_counts(backend, {prefix + "list_counts", most_list_blocks(count), 4}),
        block_starts(backend, {prefix + "list_starts", most_list_blocks(count), 4}),
        instances(backend, {prefix + "instances", placed ? count : 0, 4}),
        places(backend, {prefix + "places", placed ? count : 0, 16}),
        times(backend, {prefix + "times", timed ? count : 0, 4}) {}
  Buffer rays, hits, states, trails, steps;
  Buffer list, block_counts, block_starts;  // layout/ray_list.h
  Buffer instances, places;
  Buffer times;  // while the shutter is open, in [0, 1]
};

// What is asked of a run of rays.
struct TraceQuery {
  bool any_hit = false;           // stop at the first hit found; hits say only whether there is one
  bool steps = false;             // count the nodes visited by each ray
  bool shadow = false;            // statistics call it `occlude`
  bool common_origin = false;     // runs of 64 rays start from one point and go nearly the same way
  bool restarted = false;         // only those that `mask` has sent on
  bool judged = false;            // `mask` looks at the rays' states afterwards
  const Buffer* times = nullptr;  // of the rays, where something moves
  bool scattered = false;         // what has been scattered has a cone of its own, where there is detail
  const Buffer* cones = nullptr;  // and these are the cones
  // Only the first `some_count` rays of this list (layout/ray_list.h), all of which are rays unless it is of
  // shadow rays; null: all. The others keep what they had before: no hit, or one that `mask` has judged. The
  // CPU, which passes over rays by itself, looks at all.
  const Buffer* some = nullptr;
  uint32_t some_count = 0;
};

class Detail;

class Tracing {
 public:
  // Makes the buffers and runs `links`; `pixels` of a picture help to choose `automatic`. `leaf_map`
  // (layout/atlas.h) must outlive it, and so must `detail`,
  // which is null without levels of detail. With several objects, with `segments` of motion
  // (layout/motion.h; 0: nothing moves) and with detail `tile` becomes `wide`; with detail `wide` becomes
  // `octant` on the CPU. Throws Error(usage) where the device cannot run that traversal.
  Tracing(Backend& backend, const geometry_image::Atlas& atlas, const Buffer& leaf_map, Traversal traversal,
          uint64_t pixels, uint32_t loop_budget, uint32_t segments, const Detail* detail = nullptr);

  Traversal traversal() const { return traversal_; }  // what `automatic` became

  // Of the objects from `first` on: the bounds of all quads, and of the nodes above them. `boxes`: one an
  // object, round all of its surface; of each segment, where there are any, one after the other.
  // `whole`: of each the box that ObjectRecord::extent is of.
  void build(const Buffer& geometry, const std::vector<scene::Bounds>& boxes,
             const std::vector<scene::Bounds>& whole, size_t first);

  // The first `count` rays to their end, in as many dispatches as the budget of each needs. `roots`: a word a
  // ray says through which object it goes; null: all go through the first. False: interrupted.
  bool trace(const Buffer& geometry, const RayBuffers& rays, uint32_t count, const TraceQuery& query,
             const Interrupted& interrupted, const Buffer* roots = nullptr);

  // What all rays tolerate from now on, where there is detail (layout/detail.h).
  void set_camera(const layout::RayCone& camera) { camera_ = camera; }

  const Buffer& objects() const { return objects_; }  // layout::ObjectRecord

  // Rays that are not at their end: passes that send rays on count them here, from zero.
  const Buffer& pending() const { return pending_; }
  void clear_pending();
  uint32_t take_pending();

 private:
  template <class Push>
  void run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push, uint32_t invocations,
           const std::array<uint32_t, pass_constants>& constants = {});
  struct Tree {
    HierarchyLevels levels;
    uint32_t first_node, first_slot, first_wide;
    uint32_t first_block, blocks, first_group,
        groups;  // what boxes_blocks, boxes_leaves and wide_nodes work through
  };
  void place_trees(const geometry_image::Atlas& atlas);
  void build_links(const Tree& tree);
  void build_nodes(const Buffer& geometry, size_t object);
  void build_boxes(const Buffer& geometry, size_t object);
  void build_wide_nodes(const Buffer& geometry, size_t object);
  // Of the geometry image at whose time the segment of hierarchy `object` begins.
  uint32_t first_texel(size_t object) const {
    return image_texels_ * static_cast<uint32_t>(object / objects_a_segment_);
  }
  bool uses_boxes() const {
    return traversal_ == Traversal::tile || (traversal_ == Traversal::wide && !on_cpu_);
  }
  // What a dispatch is about (layout::TracePush::resume), and whether rays keep their states.
  struct Round {
    uint32_t resume = layout::resume_nothing;
    bool resumable = true;
  };
  // How many of `count` rays, those of query.some or the first, a dispatch has to do with, if they are few
  // enough to be put side by side, in rays.list; `waiting`: how many those are, where that is known. None:
  // all are to be looked at.
  std::optional<uint32_t> list_rays(const RayBuffers& rays, uint32_t count, const Round& round,
                                    const TraceQuery& query, std::optional<uint32_t> waiting);
  void dispatch_tiles(const Buffer& geometry, const RayBuffers& rays, uint32_t count, const Round& round);
  // `list`: which rays; null: the first.
  void dispatch(const Buffer& geometry, const RayBuffers& rays, uint32_t count, const Buffer* list,
                const TraceQuery& query, const Round& round, const Buffer* roots);

  Backend& backend_;
  const Buffer& leaf_map_;
  bool on_cpu_;
  Traversal traversal_;
  uint32_t loop_budget_;
  uint32_t segments_, objects_a_segment_, image_texels_;
  const Detail* detail_;
  layout::RayCone camera_{};
  std::vector<Tree> trees_;  // one an object, of each segment
  uint64_t node_count_ = 0, wide_count_ = 0;
  std::vector<layout::ObjectRecord> records_;
  Buffer objects_;                      // the same on the device
  Buffer nodes_lo_, nodes_hi_, links_;  // 32 bits
  Buffer leaf_blocks_, leaf_groups_;
  Buffer boxes_, wide_nodes_;  // 16 bits, the second for the CPU
  Buffer pending_;
};

}  // namespace lodestone::render
