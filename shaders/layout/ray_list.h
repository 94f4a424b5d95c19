// SPDX-License-Identifier: MIT
// The rays that a dispatch has to do with, put side by side: a lane of a device that runs lanes as a vector
// is lost where its ray is at its end already, and after a bounce most are. A list is words: how many, then
// their numbers. Their order stays, which is that of pixels; to sort rays by direction and place gives no
// more than it costs (docs/measurements.md).
#ifndef LODESTONE_LAYOUT_RAY_LIST_H
#define LODESTONE_LAYOUT_RAY_LIST_H

#include "layout/ray.h"
#include "layout/ray_state.h"
#include "layout/trace.h"

LODESTONE_LAYOUT_BEGIN

// First blocks are counted; when it is known where each begins (scan_blocks), rays are listed, and those that
// are not get the hits and states that the traversal would have given them, or cast no shadow rays any more.
CONST uint list_count = 0u;
CONST uint list_place = 1u;

struct ListPush {
  uint count;
  uint block;  // rays that are counted together
};
// One invocation goes through all blocks, and some devices cut loops off after 65,535 iterations.
CONST uint fewest_in_block = 64u;
CONST uint most_blocks = 32768u;
FN uint list_block(uint count) {
  uint block = (count - 1u) / most_blocks + 1u;
  return block < fewest_in_block ? fewest_in_block : block;
}

FN bool ray_is_wanted(Ray ray, uvec4 hit, uvec4 state, uint resume) {
  bool is_ray = !(ray.tmax < 0.0f);
  bool is_unanswered = hit.w == unanswered;
  bool goes_on = trace_goes_on(state);
  return resume == resume_nothing ? is_ray : (resume == resume_unanswered ? is_unanswered : goes_on);
}

LODESTONE_LAYOUT_END
#endif
