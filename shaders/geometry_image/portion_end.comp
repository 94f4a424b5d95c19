// SPDX-License-Identifier: MIT
// What rays have hit in a portion counts where it is nearer than all before, of equal ones the lower primitive of the whole;
// then all that is known of the surface there is kept (layout/portion.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/motion.h"
#include "layout/portion.h"
#include "layout/trace.h"

QUADS(0, readonly, local_hits);
WORDS(1, readonly, local_steps);
QUADS(2, restrict, hits);
QUADS(3, restrict, states);
WORDS(4, restrict, steps);
WORDS(5, readonly, runs);
WORDS(6, readonly, times);
QUADS(7, readonly, geometry);
QUADS(8, readonly, normal_map);
QUADS(9, readonly, texel_map);
QUADS(10, readonly, triangles);
WORDS(11, readonly, triangle_numbers);  // in the whole
QUADS(12, readonly, positions);
QUADS(13, readonly, normals);
QUADS(14, readonly, tangents);
QUADS(15, readonly, texcoords);
QUADS(16, readonly, charts);
QUADS(17, writeonly, found_hits);
QUADS(18, writeonly, found_geometry);
QUADS(19, writeonly, found_normal_map);
QUADS(20, writeonly, found_texel_map);
QUADS(21, writeonly, found_triangles);
QUADS(22, writeonly, found_positions);  // w: the triangle's number
QUADS(23, writeonly, found_normals);
QUADS(24, writeonly, found_tangents);
QUADS(25, writeonly, found_texcoords);
QUADS(26, writeonly, found_charts);
COUNTERS(27)
PUSH(PortionPush, push);

layout(constant_id = 2) const uint any_hit = 0u;  // as in `trace`
layout(constant_id = 3) const uint write_steps = 0u;
layout(constant_id = 4) const uint sources = 1u;
layout(constant_id = 5) const uint segments = 0u;
layout(constant_id = 6) const uint keep = 1u;  // 0: only what was hit is asked

uint whole_texel(uint texel) {
  uint first = 0u;  // the last run that begins at the texel or before it
  uint end = push.runs;
  while (first + 1u < end) {
    uint middle = (first + end) >> 1u;
    uint local;
    LOAD1(local, runs, 2u * middle);
    if (local <= texel) {
      first = middle;
    } else {
      end = middle;
    }
  }
  uint local;
  uint whole;
  LOAD1(local, runs, 2u * first);
  LOAD1(whole, runs, 2u * first + 1u);
  return whole + (texel - local);
}

void keep_vertex(uint vertex, uint place, uint number) {
  uvec4 bits;
  LOAD4(bits, positions, vertex);
  STORE4(found_positions, place, uvec4(bits.xyz, number));
  LOAD4(bits, normals, vertex);
  STORE4(found_normals, place, bits);
  LOAD4(bits, tangents, vertex);
  STORE4(found_tangents, place, bits);
  LOAD4(bits, texcoords, vertex);
  STORE4(found_texcoords, place, bits);
}

void keep_triangle(uint triangle, uint place) {
  uvec4 corners;
  uint number;
  LOAD4(corners, triangles, triangle);
  LOAD1(number, triangle_numbers, triangle);
  uint first = found_vertices * place;
  keep_vertex(corners.x, first, number);
  keep_vertex(corners.y, first + 1u, number);
  keep_vertex(corners.z, first + 2u, number);
  STORE4(found_triangles, place, uvec4(first, first + 1u, first + 2u, corners.w));
}

void keep_surface(uint index, uint primitive, Moment moment) {
  uint texel = primitive >> 1u;
  uint upper = primitive & 1u;
  uint image = push.image_texels * moment.segment;
  uvec4 bits;
  uvec4 next;
  LOAD4(bits, geometry, image + texel);
  uint number = bits.w - 1u;
  uvec4 record0;
  uvec4 record1;
  LOAD4(record0, charts, 2u * number);
  LOAD4(record1, charts, 2u * number + 1u);
  ChartRecord chart = chart_record(record0, record1);
  uint place = sources * index;
  for (uint i = 0u; i < found_texels; ++i) {
    uint from = image + texel + (i & 1u) + (i >> 1u) * chart.width;
    LOAD4(bits, geometry, from);
    vec3 point = as_vec3(bits);
    if (segments != 0u) {
      LOAD4(next, geometry, from + push.image_texels);
      point = moved3(point, as_vec3(next), moment.fraction);
    }
    STORE4(found_geometry, found_texels * index + i, as_bits(point, index + 1u));
  }
  uint triangle = chart.first_triangle;
  if (chart.kind == chart_grid) {
    uint offset = texel - chart.first_texel;
    triangle += 2u * (offset - offset / chart.width) + upper;
  }
  for (uint i = 0u; i < 3u; ++i) {  // the corners of the triangle that was hit
    uint slot = upper + i;
    uint from = texel + (slot & 1u) + (slot >> 1u) * chart.width;
    LOAD4(bits, normal_map, image + from);
    vec3 normal = as_vec3(bits);
    if (segments != 0u) {
      LOAD4(next, normal_map, image + from + push.image_texels);
      normal = moved3(normal, as_vec3(next), moment.fraction);
    }
    STORE4(found_normal_map, found_texels * index + slot, as_bits(normal, 0u));
    LOAD4(bits, texel_map, from);
    uint own = place;
    if (chart.kind == chart_mapped) {
      own += i;
      keep_triangle(bits.x, own);
    }
    STORE4(found_texel_map, found_texels * index + slot, uvec4(own, bits.y, bits.z, index + 1u));
  }
  if (chart.kind != chart_mapped) keep_triangle(triangle, place);
  // On a grid the half says which triangle it is, and here that is always the first.
  uint first_triangle = chart.kind == chart_grid ? place - upper : place;
  STORE4(found_charts, 2u * index, uvec4(found_texels * index, 2u, 2u, chart.kind));
  uint emitter = chart.first_emitter;  // where that is not 0, of the chart's first texel
  if (emitter != 0u) emitter += whole_texel(texel) - whole_texel(chart.first_texel);
  STORE4(found_charts, 2u * index + 1u, uvec4(first_triangle, 0u, 0u, emitter));
}

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uvec4 met;
  LOAD4(met, local_hits, index);
  if (write_steps != 0u) {
    uint before;
    uint more;
    LOAD1(before, steps, index);
    LOAD1(more, local_steps, index);
    STORE1(steps, index, before + more);
  }
  if (met.w != no_index) {
    if (any_hit != 0u) {
      uvec4 state;
      LOAD4(state, states, index);
      STORE4(states, index, uvec4(state.x, state.y, trace_finished, state.w));
      STORE4(hits, index, uvec4(0u));
    } else {
      uvec4 best;
      LOAD4(best, hits, index);
      uint primitive = 2u * whole_texel(met.w >> 1u) + (met.w & 1u);
      float t = uintBitsToFloat(met.x);
      float nearest = uintBitsToFloat(best.x);
      if (t < nearest || (t == nearest && primitive < best.w)) {
        STORE4(hits, index, uvec4(met.xyz, primitive));
        if (keep != 0u) {
          STORE4(found_hits, index, uvec4(met.xyz, 2u * found_texels * index + (met.w & 1u)));
          Moment moment;
          moment.segment = 0u;
          moment.fraction = 0.0;
          if (segments != 0u) {
            uint time;
            LOAD1(time, times, index);
            moment = moment_of(uintBitsToFloat(time), segments);
          }
          keep_surface(index, met.w, moment);
        }
      }
    }
  }
  flush_counters();
}
