// SPDX-License-Identifier: MIT
// Hit and miss link of every node, once per atlas (section 3.1 of the paper). Hit: the first child, or for a leaf the
// texel of its quad. Miss: the next sibling, or that of an ancestor; places without a quad are passed over.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/atlas.h"
#include "layout/links.h"

WORDS(0, readonly, leaf_map);
WORDS(1, writeonly, links);
COUNTERS(2)
PUSH(LinksPush, push);

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uint address = level_base(push.depth) + index;
  uint hit = 4u * address + 1u;
  if (push.depth == push.leaf_depth) {
    uint texel;
    LOAD1(texel, leaf_map, 2u * (push.first_slot + index));
    hit = leaf_flag | texel;
  }
  STORE1(links, 2u * (push.first_node + address), hit);

  // Skip siblings that hold no quad at all; on the leaves' level every empty slot.
  uint depth = push.depth;
  uint next = index + 1u;
  bool searching = true;
  while (searching) {
    uint up = uint(findLSB(next)) >> 1u;
    bool finished = up >= depth;
    uint place = finished ? 0u : next >> (2u * up);
    uint level = finished ? 0u : depth - up;
    searching = false;
    if (!finished && (place << (2u * (push.leaf_depth - level))) >= push.slots) {
      finished = true;  // everything behind it is padding
    }
    if (!finished && level == push.leaf_depth) {
      uint texel;
      LOAD1(texel, leaf_map, 2u * (push.first_slot + place));
      if (texel == empty_slot) {
        searching = true;
        next = place + 1u;
        depth = level;
      }
    }
    if (!searching) STORE1(links, 2u * (push.first_node + address) + 1u, finished ? 0u : level_base(level) + place);
  }
  flush_counters();
}
