// SPDX-License-Identifier: MIT
// What a kernel counts in one dispatch, when specialization constant 1 says so: eight low words, then eight
// high ones.
#ifndef LODESTONE_LAYOUT_COUNTERS_H
#define LODESTONE_LAYOUT_COUNTERS_H

#include "layout/types.h"

LODESTONE_LAYOUT_BEGIN
CONST uint counter_bytes_read = 0u;     // in words of 4 bytes
CONST uint counter_bytes_written = 1u;  // in words of 4 bytes
CONST uint counter_rays = 2u;
CONST uint counter_node_visits = 3u;
CONST uint counter_box_tests = 4u;
CONST uint counter_triangle_tests = 5u;
CONST uint counter_lane_steps = 6u;
CONST uint counter_subgroup_steps = 7u;  // steps of a subgroup times its size
CONST uint counter_count = 8u;
CONST uint counter_words = 16u;
LODESTONE_LAYOUT_END
#endif
