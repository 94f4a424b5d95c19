// SPDX-License-Identifier: MIT
// The geometry image and the normal map of this frame (section 3.2 of the paper): each texel is the point of its triangle
// that the texel map says. Texels at one place of the surface have one and the same formula, so chart borders are equal to
// the bit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/arithmetic.h"
#include "layout/frame.h"

QUADS(0, readonly, texel_map);
QUADS(1, readonly, triangles);
QUADS(2, readonly, positions);
QUADS(3, readonly, normals);
QUADS(4, writeonly, geometry);
QUADS(5, writeonly, normal_map);
COUNTERS(6)
PUSH(RasterisePush, push);

void main() {
  uint texel = invocation();
  if (texel >= push.count) return;
  texel += push.first;
  uvec4 source;
  LOAD4(source, texel_map, texel);
  uvec4 point = uvec4(0u);
  uvec4 direction = uvec4(0u);
  if (source.w != 0u) {
    uvec4 triangle;
    LOAD4(triangle, triangles, source.x);
    float b1 = uintBitsToFloat(source.y);
    float b2 = uintBitsToFloat(source.z);
    float b0 = 1.0 - b1 - b2;
    uvec4 p0;
    uvec4 p1;
    uvec4 p2;
    LOAD4(p0, positions, triangle.x);
    LOAD4(p1, positions, triangle.y);
    LOAD4(p2, positions, triangle.z);
    point = as_bits(flush_tiny3(as_vec3(p0) * b0 + as_vec3(p1) * b1 + as_vec3(p2) * b2), source.w);
    LOAD4(p0, normals, triangle.x);
    LOAD4(p1, normals, triangle.y);
    LOAD4(p2, normals, triangle.z);
    direction = as_bits(as_vec3(p0) * b0 + as_vec3(p1) * b1 + as_vec3(p2) * b2, 0u);
  }
  STORE4(geometry, push.image + texel, point);
  STORE4(normal_map, push.image + texel, direction);
  flush_counters();
}
