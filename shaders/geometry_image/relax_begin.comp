// SPDX-License-Identifier: MIT
// What a frame's relaxation starts from: the texel map of the atlas, each texel at its own point of the lattice.
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
QUADS(3, readonly, charts);
QUADS(4, readonly, rest_positions);
WORDS(5, readonly, face_of_texel);
QUADS(6, writeonly, relaxed_map);
QUADS(7, writeonly, sites);
QUADS(8, writeonly, now);
QUADS(9, writeonly, was);
COUNTERS(10)
PUSH(CountPush, push);

void main() {
  uint texel = invocation();
  if (texel >= push.count) return;
  uvec4 source;
  LOAD4(source, texel_map, texel);
  STORE4(relaxed_map, texel, source);
  if (source.w != 0u) {
    uvec4 chart;
    LOAD4(chart, charts, 2u * (source.w - 1u));
    if (chart.w == chart_mapped) {
      uint face;
      LOAD1(face, face_of_texel, texel);
      uint x = (texel - chart.x) % chart.y;
      uint y = (texel - chart.x) / chart.y;
      vec3 point;
      STORE4(sites, texel, uvec4(floatBitsToUint(float(x)), floatBitsToUint(float(y)), face, floatBitsToUint(1.0)));
      TEXEL_POINT(point, positions, source);
      STORE4(now, texel, as_bits(point, 0u));
      TEXEL_POINT(point, rest_positions, source);
      STORE4(was, texel, as_bits(point, 0u));
    }
  }
  flush_counters();
}
