// SPDX-License-Identifier: MIT
// Alpha masks: a hit on a cut-out texel is no hit; its ray goes on from there in another round of `trace`. Any other hit
// is marked, so that later rounds need not look at it again.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "geometry_image/surface.glsl"

QUADS(19, restrict, rays);
QUADS(20, restrict, states);
STRUCTS(21, restrict, uint, pending);
COUNTERS(22)
PUSH(CountPush, push);

bool is_cut_out(uint index, uvec4 hit) {
  SurfacePoint point = locate_hit(index, hit);
  MaterialRecord material = materials[parts[point.part].material];
  count_read(24u);
  if (material.alpha_mask == 0u) return false;
  return base_color_at(material, point, texcoords_at(point)).w < material.alpha_cutoff;
}

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uvec4 hit;
  LOAD4(hit, hits, index);
  if (hit.w != no_index) {
    uvec4 state;
    LOAD4(state, states, index);
    if (trace_status(state) != trace_judged) {
      if (is_cut_out(index, hit)) {
        uvec4 from;
        LOAD4(from, rays, 2u * index);
        from.w = hit.x;
        STORE4(rays, 2u * index, from);
        STORE4(states, index, uvec4(0u, placed_by(index), trace_restart, hit.w + 1u));
        atomicAdd(pending[0], 1u);
      } else {
        STORE4(states, index, uvec4(0u, 0u, trace_judged, no_index));
      }
    }
  }
  flush_counters();
}
