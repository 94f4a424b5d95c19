// SPDX-License-Identifier: MIT
// What the traversals of single nodes share: the hierarchy in 32 bits. Before this come counters.
#include "layout/trace.h"

QUADS(6, readonly, nodes_lo);
QUADS(7, readonly, nodes_hi);
PUSH(TracePush, push);

#include "geometry_image/trace.glsl"
