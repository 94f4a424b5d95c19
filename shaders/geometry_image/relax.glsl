// SPDX-License-Identifier: MIT
// The point of `vertices` (a buffer) that `source`, an entry of a texel map, is of its triangle, as `rasterise` has it.
#define TEXEL_POINT(result, vertices, source)                                              \
  {                                                                                        \
    uvec4 corners;                                                                         \
    uvec4 p0;                                                                              \
    uvec4 p1;                                                                              \
    uvec4 p2;                                                                              \
    LOAD4(corners, triangles, source.x);                                                   \
    LOAD4(p0, vertices, corners.x);                                                        \
    LOAD4(p1, vertices, corners.y);                                                        \
    LOAD4(p2, vertices, corners.z);                                                        \
    float b1 = uintBitsToFloat(source.y);                                                  \
    float b2 = uintBitsToFloat(source.z);                                                  \
    float b0 = 1.0 - b1 - b2;                                                              \
    result = flush_tiny3(as_vec3(p0) * b0 + as_vec3(p1) * b1 + as_vec3(p2) * b2);          \
  }
