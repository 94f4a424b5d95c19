// SPDX-License-Identifier: MIT
// The weight of each inner texel of a mapped chart: how much more than in the rest pose the surface needs samples there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/relax.h"

WORDS(0, readonly, inner_texels);
QUADS(1, readonly, charts);
QUADS(2, readonly, relaxed_map);
QUADS(3, readonly, now);
QUADS(4, readonly, was);
QUADS(5, restrict, sites);
COUNTERS(6)
PUSH(RelaxPush, push);

#define LOAD_RING(ring, texels)                                           \
  {                                                                       \
    uvec4 bits;                                                           \
    vec3 points[6];                                                       \
    for (uint k = 0u; k < relax_neighbors; ++k) {                         \
      LOAD4(bits, texels, relax_neighbor(texel, width, k));               \
      points[k] = as_vec3(bits);                                          \
    }                                                                     \
    LOAD4(bits, texels, texel);                                           \
    ring = relax_ring(as_vec3(bits), points);                             \
  }

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uint texel;
  LOAD1(texel, inner_texels, push.first + index);
  uvec4 source;
  LOAD4(source, relaxed_map, texel);
  uvec4 chart;
  LOAD4(chart, charts, 2u * (source.w - 1u));
  uint width = chart.y;
  RelaxRing ring_now;
  RelaxRing ring_was;
  LOAD_RING(ring_now, now);
  LOAD_RING(ring_was, was);
  uvec4 site;
  LOAD4(site, sites, texel);
  site.w = floatBitsToUint(relax_weight(ring_now, ring_was));
  STORE4(sites, texel, site);
  flush_counters();
}
