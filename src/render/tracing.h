// SPDX-License-Identifier: MIT
// The hierarchy over the geometry image, built every frame, and rays traced through it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/layout/boxes.h"
#include "lodestone/render/backend.h"
#include "lodestone/render/hierarchy_levels.h"
#include "lodestone/render/renderer.h"
#include "lodestone/scene/pose.h"

namespace lodestone::render {

using Interrupted = std::function<bool()>;

// The rays of one kind (primary, or to a light), two quads each as layout/ray.h has them, and what they
// found.
struct RayBuffers {
  RayBuffers() = default;
  RayBuffers(Backend& backend, const std::string& prefix, uint64_t count)
      : rays(backend, {prefix + "rays", 2 * count, 16}),
        hits(backend, {prefix + "hits", count, 16}),
        states(backend, {prefix + "states", count, 16}),
        trails(backend, {prefix + "trails", count, 16}),
        steps(backend, {prefix + "steps", count, 4}) {}
  Buffer rays, hits, states, trails, steps;
};

// What is asked of a run of rays.
struct TraceQuery {
  bool any_hit = false;        // stop at the first hit found; hits say only whether there is one
  bool steps = false;          // count the nodes visited by each ray
  bool shadow = false;         // statistics call it `occlude`
  bool common_origin = false;  // runs of 64 rays start from one point and go nearly the same way
};

class Tracing {
 public:
  // Makes the buffers and runs `links`. `leaf_map` (layout/atlas.h) must outlive it. Throws Error(usage)
  // where the device cannot run that traversal.
  Tracing(Backend& backend, const geometry_image::Atlas& atlas, const Buffer& leaf_map, Traversal traversal,
          uint32_t loop_budget);

  Traversal traversal() const { return traversal_; }  // what `automatic` became

  // The bounds of all quads, and of the nodes above them. `frame` holds all of the surface.
  void build(const Buffer& geometry, const scene::Bounds& frame);

  // The first `count` rays to their end, in as many dispatches as the budget of each needs; those that `mask`
  // sends on, if `pending` says that there are some. False: interrupted.
  bool trace(const Buffer& geometry, const RayBuffers& rays, uint32_t count, const TraceQuery& query,
             const Interrupted& interrupted);

  // Rays that are not at their end: passes that send rays on count them here.
  const Buffer& pending() const { return pending_; }
  uint32_t take_pending();

 private:
  template <class Push>
  void run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push, uint32_t invocations,
           const std::array<uint32_t, pass_constants>& constants = {});
  void build_links();
  void build_nodes(const Buffer& geometry);
  void build_boxes(const Buffer& geometry, const scene::Bounds& frame);
  bool uses_boxes() const {
    return traversal_ == Traversal::tile || (traversal_ == Traversal::wide && !on_cpu_);
  }
  void dispatch_tiles(const Buffer& geometry, const RayBuffers& rays, uint32_t count);
  void dispatch(const Buffer& geometry, const RayBuffers& rays, uint32_t count, const TraceQuery& query,
                bool resume);

  Backend& backend_;
  const Buffer& leaf_map_;
  bool on_cpu_;
  Traversal traversal_;
  uint32_t loop_budget_;
  HierarchyLevels levels_;
  layout::BoxGrid grid_{};
  Buffer nodes_lo_, nodes_hi_, links_, wide_nodes_;  // 32 bits, and the CPU's copy in 16
  Buffer leaf_blocks_, leaf_groups_;                 // what boxes_blocks and boxes_leaves work through
  uint32_t block_count_ = 0, group_count_ = 0;
  Buffer boxes_, extent_;  // 16 bits
  Buffer pending_;
};

}  // namespace lodestone::render
