// SPDX-License-Identifier: MIT
// Levels of detail (layout/detail.h) of the nodes of the hierarchy: when a node is one quad, and how far what
// is between its corners may be outside the bounds of its children.
#ifndef LODESTONE_LAYOUT_DETAIL_NODES_H
#define LODESTONE_LAYOUT_DETAIL_NODES_H

#include "layout/atlas.h"
#include "layout/detail.h"
#include "layout/frame.h"

LODESTONE_LAYOUT_BEGIN

// Address of the node above one that is not the root.
FN uint node_above(uint address) {
  uint bits = 3u * address + 1u;  // in level k from 4^k on
  uint depth = uint(findMSB(bits)) >> 1u;
  return level_base(depth - 1u) + ((address - level_base(depth)) >> 2u);
}

// The least and the largest that it can be within `radius` of p.
FN vec1 least_tolerance(IN(Tolerance) t, vec3 p, vec1 radius) {
  vec1 camera = max2(distance_to(p, t.camera.apex) - radius, 0.0f);
  vec1 scattered = max2(distance_to(p, t.scattered.apex) - radius, 0.0f);
  return max2(t.camera.width + t.camera.spread * camera, t.scattered.width + t.scattered.spread * scattered);
}
FN vec1 largest_tolerance(IN(Tolerance) t, vec3 p, vec1 radius) {
  return max2(t.camera.width + t.camera.spread * (distance_to(p, t.camera.apex) + radius),
              t.scattered.width + t.scattered.spread * (distance_to(p, t.scattered.apex) + radius));
}

// For rounding, of distances (below 2^-20) and of what is summed from the bottom up.
CONST float detail_slack = 1.000244140625f;  // 1 + 2^-12

// From here on a node is its quad.
FN float whole_from(float largest_radius) {
  return largest_radius < 1e37f ? (1.0f + slide_band) * largest_radius * detail_slack : fixed_radius;
}
// The least radius of the corners of a node that is its quad from `whole` on and within `extent` of a point.
FN float corner_radius(float whole, float extent, float steepest) {
  return whole < 1e37f ? (whole + 2.0f * steepest * extent) * detail_slack : fixed_radius;
}

// How far p is from the line from a to b, between them.
FN float deviation(vec3 p, vec3 a, vec3 b) {
  vec3 along = flush_tiny3(b - a);
  vec3 to = flush_tiny3(p - a);
  float size = dot3(along, along);
  float part = size > 0.0f ? clamp1(dot3(to, along) / size, 0.0f, 1.0f) : 0.0f;
  return distance_to(to, along * part);
}

// A node over 2 x 2 quads or more of one chart, as the passes work through them: two quads, { its number in
// the detail of nodes, that of its first child (no_index: leaves), texel of corner a, flags }, { to corner b,
// to c, to the middle of a b (0: there is none), to the middle of a c (0: none) }, in texels.
struct CoarseNode {
  uint node;
  uint first_child;
  uint texel;
  uint flags;
  uint across;
  uint along;
  uint half_across;
  uint half_along;
};
CONST uint coarse_whole = 1u;  // it can become one quad

FN CoarseNode coarse_node(uvec4 a, uvec4 b) {
  CoarseNode node;
  node.node = a.x;
  node.first_child = a.y;
  node.texel = a.z;
  node.flags = a.w;
  node.across = b.x;
  node.along = b.y;
  node.half_across = b.z;
  node.half_along = b.w;
  return node;
}

// The detail of a node, two quads: { a point, within `extent` of which is all of it }, { tolerance from which
// on it is its quad, tolerance from which on texels between its corners slide, how far they can along x and y
// (16 bits each, the upper half of a float, rounded up) and z }. Nodes that are not of one chart are never
// their quad.
struct NodeDetail {
  vec3 middle;
  float extent;
  float whole;  // until it is settled: the error of its quad
  float moves;
  vec3 margin;
};

FN uint upper_half(float x) {
  return (floatBitsToUint(x) + 0xffffu) >> 16u;
}
FN uvec4 settled_bits(float whole, float moves, vec3 margin) {
  return uvec4(floatBitsToUint(whole), floatBitsToUint(moves),
               upper_half(margin.x) | upper_half(margin.y) << 16u, floatBitsToUint(margin.z));
}

FN NodeDetail node_detail(uvec4 a, uvec4 b) {
  NodeDetail d;
  d.middle = vec3(uintBitsToFloat(a.x), uintBitsToFloat(a.y), uintBitsToFloat(a.z));
  d.extent = uintBitsToFloat(a.w);
  d.whole = uintBitsToFloat(b.x);
  d.moves = uintBitsToFloat(b.y);
  d.margin = vec3(uintBitsToFloat(b.z << 16u), uintBitsToFloat(b.z & 0xffff0000u), uintBitsToFloat(b.w));
  return d;
}

FN bool is_whole(IN(NodeDetail) d, IN(Tolerance) t) {
  return d.whole < fixed_radius && least_tolerance(t, d.middle, d.extent) >= d.whole;
}
// How far the bounds of its children must be widened: as far as that which slides first can have come.
FN vec3 child_margin(IN(NodeDetail) d, IN(Tolerance) t) {
  float largest = largest_tolerance(t, d.middle, d.extent) * detail_slack;
  float part = min2((largest - d.moves) / (d.moves * slide_band) * detail_slack, 1.0f);
  return d.margin * (largest > d.moves ? part : 0.0f);
}

// Coarse quads, a quad buffer: what a node is a quad of, { texel of corner a, to b, to c, level }.

struct DetailPush {
  uint first;  // of the list of coarse nodes
  uint count;
  float steepest;
};

LODESTONE_LAYOUT_END
#endif
