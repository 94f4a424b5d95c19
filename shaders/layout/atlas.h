// SPDX-License-Identifier: MIT
// The geometry image and its hierarchy, as they lie in buffers.
//
// A chart is a rectangle of width x height texels (samples of the surface) in one run of the geometry image,
// row by row; its (width-1) x (height-1) quads are leaves of the hierarchy. The leaves of a chart, in Morton
// order, fill a block of 2^k slots that starts at a multiple of 2^k; slots without a quad are empty. The
// blocks of all charts, one after the other, are the leaves of one implicit 4-ary tree: the lower levels are
// each chart's MIP pyramid, the upper ones the static tree over the charts. Where k is odd, a block is half
// of a node (two of its children), and the other half is another chart or smaller ones. Level `depth` (0: the
// root) has 4^depth places; node `index` of it is at address (4^depth - 1) / 3 + index, and its children are
// 4 * index + 0..3 of the next. One address serves the links, the bounds and the leaf map (section 3.2 of the
// paper: "a single uv coordinate").
#ifndef LODESTONE_LAYOUT_ATLAS_H
#define LODESTONE_LAYOUT_ATLAS_H

#include "layout/types.h"

LODESTONE_LAYOUT_BEGIN

CONST uint no_index = 0xffffffffu;
CONST uint max_depth = 14u;           // 4^14 leaf slots
CONST uint leaf_flag = 0x80000000u;   // in a hit link: the rest is the texel of the quad's corner a
CONST uint empty_slot = 0x7fffffffu;  // a leaf slot without a quad

// What a chart's quads stand for.
CONST uint chart_grid = 0u;  // quad (x, y) half h is triangle first_triangle + 2 * (y * (width - 1) + x) + h
CONST uint chart_exact =
    1u;  // a 3 x 3 chart that is triangle first_triangle: corners, edge midpoints, centroid
CONST uint chart_mapped =
    2u;  // a surface resampled: every texel lies in a triangle of its own (first_triangle is 0)

struct ChartRecord {
  uvec1 first_texel;
  uvec1 width;
  uvec1 height;
  uvec1 kind;
  uvec1 first_triangle;  // in the triangle buffer
  uvec1 first_slot;
  uvec1 slot_count;     // a power of 2
  uvec1 first_emitter;  // 1 + the number of its first texel among emitters (layout/emitters.h); 0: it does
                        // not shine
};
// There can be a chart a triangle, so that charts too are an array of quads, two each.
FN ChartRecord chart_record(uvec4 a, uvec4 b) {
  ChartRecord chart;
  chart.first_texel = a.x;
  chart.width = a.y;
  chart.height = a.z;
  chart.kind = a.w;
  chart.first_triangle = b.x;
  chart.first_slot = b.y;
  chart.slot_count = b.z;
  chart.first_emitter = b.w;
  return chart;
}

// Texel map, a quad buffer: { triangle, barycentric of vertex 1, of vertex 2 (float bits), chart + 1 }; all
// zero: no texel. Leaf map, a word buffer, two words a slot: { texel of corner a (empty_slot: none), row
// stride in texels }. Links, a word buffer, two words a node: { hit, miss }; 0 ends the traversal. Geometry
// image, a quad buffer: { x, y, z (float bits), chart + 1 }; w = 0: no texel. Normal map, a quad buffer: { x,
// y, z (float bits, not normalised), 0 }. Bounds, two quad buffers: lo { min x, y, z, a }, hi { max x, y, z,
// b }. Leaf: a = leaf_flag | texel, b = stride. Inner node: a = visiting order, 2 bits an octant: child k of
// octant o is ((a >> 2 o) & 3) ^ k; b = 0.

FN uvec1 level_base(uvec1 depth) {
  return 0x55555555u & ((uvec1(1u) << (2u * depth)) - 1u);
}

// Morton code of (x, y), 16 bits each: x in the even bits.
FN uvec1 spread_bits(uvec1 x) {
  x = x & 0xffffu;
  x = (x | (x << 8u)) & 0x00ff00ffu;
  x = (x | (x << 4u)) & 0x0f0f0f0fu;
  x = (x | (x << 2u)) & 0x33333333u;
  x = (x | (x << 1u)) & 0x55555555u;
  return x;
}
FN uvec1 gather_bits(uvec1 x) {
  x = x & 0x55555555u;
  x = (x | (x >> 1u)) & 0x33333333u;
  x = (x | (x >> 2u)) & 0x0f0f0f0fu;
  x = (x | (x >> 4u)) & 0x00ff00ffu;
  x = (x | (x >> 8u)) & 0x0000ffffu;
  return x;
}

#ifdef __cplusplus
static_assert(sizeof(ChartRecord) == 2 * sizeof(uvec4));
#endif

LODESTONE_LAYOUT_END
#endif
