// SPDX-License-Identifier: MIT
// What a frame's relaxation starts from: the texel map of the atlas, each texel where the atlas has it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/arithmetic.h"
#include "layout/atlas.h"
#include "layout/frame.h"
#include "relax.glsl"

QUADS(0, readonly, texel_map);
QUADS(1, readonly, triangles);
QUADS(2, readonly, positions);
QUADS(3, readonly, rest_positions);
QUADS(4, readonly, map_sites);
QUADS(5, writeonly, relaxed_map);
QUADS(6, writeonly, sites);
QUADS(7, writeonly, now);
QUADS(8, writeonly, was);
COUNTERS(9)
PUSH(CountPush, push);

void main() {
  uint texel = invocation();
  if (texel >= push.count) return;
  uvec4 source;
  LOAD4(source, texel_map, texel);
  STORE4(relaxed_map, texel, source);
  if (source.w != 0u) {
    uvec4 site;
    vec3 point;
    LOAD4(site, map_sites, texel);
    STORE4(sites, texel, site);
    TEXEL_POINT(point, positions, source);
    STORE4(now, texel, as_bits(point, 0u));
    TEXEL_POINT(point, rest_positions, source);
    STORE4(was, texel, as_bits(point, 0u));
  }
  flush_counters();
}
