// SPDX-License-Identifier: MIT
// Vertices of this frame: base plus weighted morph deltas, then the blended matrix of the skin (glTF 2.0: morph before skin).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/arithmetic.h"
#include "layout/frame.h"

QUADS(0, readonly, base_positions);
QUADS(1, readonly, base_normals);     // w: colour
QUADS(2, readonly, base_tangents);    // w: sign of the bitangent
QUADS(3, readonly, vertex_ranges);    // morphs begin, end, influences begin, end
QUADS(4, readonly, morph_positions);  // weight index, delta x y z
QUADS(5, readonly, morph_normals);
QUADS(6, readonly, morph_tangents);
WORDS(7, readonly, influences);       // matrix, weight
WORDS(8, readonly, weights);
QUADS(9, readonly, matrices);         // three rows each
QUADS(10, writeonly, positions);
QUADS(11, writeonly, normals);
QUADS(12, writeonly, tangents);
COUNTERS(13)
PUSH(BlendPush, push);

vec4 weighted_row(uint matrix, uint row, float weight) {
  uvec4 bits;
  LOAD4(bits, matrices, 3u * matrix + row);
  return as_vec4(bits) * weight;
}

void main() {
  uint vertex = invocation();
  if (vertex >= push.vertices) return;
  vertex += push.first;
  uvec4 range;
  uvec4 position_bits;
  uvec4 normal_bits;
  LOAD4(range, vertex_ranges, vertex);
  LOAD4(position_bits, base_positions, vertex);
  LOAD4(normal_bits, base_normals, vertex);
  uvec4 tangent_bits = uvec4(0u);
  if (push.tangents != 0u) LOAD4(tangent_bits, base_tangents, vertex);
  vec3 position = as_vec3(position_bits);
  vec3 normal = as_vec3(normal_bits);
  vec3 tangent = as_vec3(tangent_bits);

  for (uint i = range.x; i < range.y; ++i) {
    uvec4 entry;
    uvec4 normal_delta;
    uint weight_bits;
    LOAD4(entry, morph_positions, i);
    LOAD4(normal_delta, morph_normals, i);
    LOAD1(weight_bits, weights, entry.x);
    float weight = uintBitsToFloat(weight_bits);
    position = position + weight * vec3(uintBitsToFloat(entry.y), uintBitsToFloat(entry.z), uintBitsToFloat(entry.w));
    normal = normal + weight * as_vec3(normal_delta);
    if (push.tangents != 0u) {
      uvec4 tangent_delta;
      LOAD4(tangent_delta, morph_tangents, i);
      tangent = tangent + weight * as_vec3(tangent_delta);
    }
  }

  uint first_matrix;
  uint first_weight;
  LOAD1(first_matrix, influences, 2u * range.z);
  LOAD1(first_weight, influences, 2u * range.z + 1u);
  vec4 row0 = weighted_row(first_matrix, 0u, uintBitsToFloat(first_weight));
  vec4 row1 = weighted_row(first_matrix, 1u, uintBitsToFloat(first_weight));
  vec4 row2 = weighted_row(first_matrix, 2u, uintBitsToFloat(first_weight));
  for (uint i = range.z + 1u; i < range.w; ++i) {
    uint matrix;
    uint weight_bits;
    LOAD1(matrix, influences, 2u * i);
    LOAD1(weight_bits, influences, 2u * i + 1u);
    float weight = uintBitsToFloat(weight_bits);
    row0 = row0 + weighted_row(matrix, 0u, weight);
    row1 = row1 + weighted_row(matrix, 1u, weight);
    row2 = row2 + weighted_row(matrix, 2u, weight);
  }
  vec3 r0 = vec3(row0.x, row0.y, row0.z);
  vec3 r1 = vec3(row1.x, row1.y, row1.z);
  vec3 r2 = vec3(row2.x, row2.y, row2.z);
  vec3 moved = vec3(dot3(r0, position) + row0.w, dot3(r1, position) + row1.w, dot3(r2, position) + row2.w);
  STORE4(positions, vertex, as_bits(flush_tiny3(moved), 0u));

  // Normals go by the cofactor matrix, which needs no inverse; its sign is that of the determinant.
  vec3 c0 = cross3(r1, r2);
  vec3 c1 = cross3(r2, r0);
  vec3 c2 = cross3(r0, r1);
  vec3 turned = vec3(dot3(c0, normal), dot3(c1, normal), dot3(c2, normal));
  bool mirrored = dot3(r0, c0) < 0.0;
  if (mirrored) turned = turned * -1.0;
  STORE4(normals, vertex, as_bits(normalize_or(turned, vec3(0.0, 0.0, 1.0)), normal_bits.w));
  if (push.tangents != 0u) {
    vec3 along = vec3(dot3(r0, tangent), dot3(r1, tangent), dot3(r2, tangent));
    STORE4(tangents, vertex, as_bits(normalize_or(along, vec3(0.0, 0.0, 0.0)), mirrored ? tangent_bits.w ^ 0x80000000u : tangent_bits.w));
  }
  flush_counters();
}
