// SPDX-License-Identifier: MIT
// How an atlas gets coarser (shaders/layout/detail.h): into which neighbour each texel can collapse, and
// which nodes of the hierarchy are a single quad when all between their corners have. Static per atlas.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

// A node of the hierarchy over 2^level x 2^level quads of one chart, fewer where the chart ends.
struct CoarseNode {
  uint32_t object = 0;
  uint32_t level = 1;        // 1: over four quads
  uint32_t index = 0;        // on its level of its object's tree
  uint32_t texel = 0;        // of corner a
  uint32_t across = 0;       // from there to corner b, in texels ...
  uint32_t along = 0;        // ... and to corner c
  uint32_t half_across = 0;  // to the corner of its quads between a and b; 0: there is none
  uint32_t half_along = 0;   // and between a and c
  bool whole = false;        // it can become one quad
};

struct CollapseMap {
  // Of each texel: the first that is the same point in every pose. They collapse as one.
  std::vector<uint32_t> points;
  // The texel of its chart that it collapses into; itself where it never does.
  std::vector<uint32_t> parents;
  // All nodes between whose corners something can collapse, finer levels first: those of level k + 1 end at
  // levels[k].
  std::vector<CoarseNode> nodes;
  std::vector<uint32_t> levels;
  // The same nodes as radii have to be known: what is between the corners of one is a corner of none in its
  // own step or behind it. Step k ends at steps[k].
  std::vector<uint32_t> order;
  std::vector<uint32_t> steps;
};

// `kept`: of each chart whether all of it stays as it is; empty: none does.
CollapseMap make_collapse_map(const scene::Assembly& assembly, const Atlas& atlas,
                              const std::vector<bool>& kept = {});

}  // namespace lodestone::geometry_image
