// SPDX-License-Identifier: MIT
#ifndef LODESTONE_LAYOUT_RAY_STATE_H
#define LODESTONE_LAYOUT_RAY_STATE_H

#include "layout/types.h"

LODESTONE_LAYOUT_BEGIN

// Traversal states between dispatches: { order, turns, 4 * depth + status, next } or { link, 0, status, next
// }; `next` as accept_triangle (trace.h) has it. At a restart, the second word is the instance that `next`
// belongs to (layout/objects.h).
CONST uint trace_finished = 0u;
CONST uint trace_unfinished = 1u;
CONST uint trace_restart = 2u;  // from the root, with nothing hit (the ray's tmin has moved)
CONST uint trace_judged = 3u;   // finished, and `mask` has found that its hit is one
// Instead of a primitive: the ray's budget was spent. So say dispatches that keep no states, for which words
// have to be stored one by one on a device that runs lanes as a vector.
CONST uint unanswered = 0xfffffffeu;
FN uvec1 trace_status(uvec4 state) {
  return state.z & 3u;
}
FN bvec1 trace_goes_on(uvec4 state) {
  return trace_status(state) == trace_unfinished || trace_status(state) == trace_restart;
}
FN uvec1 trace_depth(uvec4 state) {
  return state.z >> 2u;
}

LODESTONE_LAYOUT_END
#endif
