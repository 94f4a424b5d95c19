// SPDX-License-Identifier: MIT
// The hierarchy over the geometry image, built every frame, and rays traced through it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/render/backend.h"
#include "lodestone/render/hierarchy_levels.h"
#include "lodestone/render/renderer.h"

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
        steps(backend, {prefix + "steps", count, 4}) {}
  Buffer rays, hits, states, steps;
};

// What is asked of a run of rays.
struct TraceQuery {
  bool any_hit = false;  // stop at the first hit found; hits say only whether there is one
  bool steps = false;    // count the nodes visited by each ray
  bool shadow = false;   // statistics call it `occlude`
};

class Tracing {
 public:
  // Makes the buffers and runs `links`. `leaf_map` (layout/atlas.h) must outlive it. Throws Error(usage)
  // where the device cannot run that traversal.
  Tracing(Backend& backend, const geometry_image::Atlas& atlas, const Buffer& leaf_map, Traversal traversal,
          uint32_t loop_budget);

  Traversal traversal() const { return traversal_; }  // what `automatic` became

  // The bounds of all quads, and of the nodes above them.
  void build(const Buffer& geometry);

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

  Backend& backend_;
  const Buffer& leaf_map_;
  Traversal traversal_;
  uint32_t loop_budget_;
  HierarchyLevels levels_;
  Buffer nodes_lo_, nodes_hi_, wide_nodes_, links_, pending_;
};

}  // namespace lodestone::render
