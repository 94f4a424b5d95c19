// SPDX-License-Identifier: MIT
// The passes that find out how nodes and texels get coarser (layout/detail.h). Included by kernels behind the
// buffers it names, and by the CPU fallback inside a class whose members have those names; LOAD4, LOAD1,
// STORE4, RADIUS, and RAISE for an atomic maximum of a point's radius, mean the same in both.

FN CoarseNode load_coarse_node(uint index) {
  uvec4 a;
  uvec4 b;
  LOAD4(a, coarse_nodes, 2u * index);
  LOAD4(b, coarse_nodes, 2u * index + 1u);
  return coarse_node(a, b);
}

FN vec3 position_of(uint texel) {
  uvec4 bits;
  LOAD4(bits, geometry, texel);
  return as_vec3(bits);
}

// Corner `i` of the node's quads that lies between the node's own: 0 and 4 between a and b and c and d, 1 and
// 3 between a and c and b and d, 2 in the middle. no_index: there is none.
FN uint between_corners(IN(CoarseNode) node, uint i) {
  bool wide = node.half_across != 0u;
  bool high = node.half_along != 0u;
  if (i == 0u) return wide ? node.texel + node.half_across : no_index;
  if (i == 1u) return high ? node.texel + node.half_along : no_index;
  if (i == 2u) return wide && high ? node.texel + node.half_across + node.half_along : no_index;
  if (i == 3u) return high ? node.texel + node.across + node.half_along : no_index;
  return wide ? node.texel + node.along + node.half_across : no_index;
}

FN bool has_child(IN(CoarseNode) node, uint k) {
  return (node.flags & coarse_whole) != 0u && node.first_child != no_index &&
         ((k & 1u) == 0u || node.half_across != 0u) && (k < 2u || node.half_along != 0u);
}

FN NodeDetail load_detail(uint number) {
  uvec4 a;
  uvec4 b;
  LOAD4(a, node_details, 2u * number);
  LOAD4(b, node_details, 2u * number + 1u);
  return node_detail(a, b);
}

// Where a node is and what is lost when what lies between its corners collapses: the least that the radii of
// that can be.
FN void measure_node(uint index) {
  CoarseNode node = load_coarse_node(index);
  vec3 a = position_of(node.texel);
  vec3 b = position_of(node.texel + node.across);
  vec3 c = position_of(node.texel + node.along);
  vec3 d = position_of(node.texel + node.across + node.along);
  vec3 middle = flush_tiny3((b + c) * 0.5f);
  float extent = max2(max2(distance_to(a, middle), distance_to(b, middle)),
                      max2(distance_to(c, middle), distance_to(d, middle)));
  float own_error = 0.0f;
  vec3 margin = vec3(0.0f, 0.0f, 0.0f);
  for (uint i = 0u; i < 5u; ++i) {
    uint texel = between_corners(node, i);
    if (texel != no_index) {
      vec3 p = position_of(texel);
      extent = max2(extent, distance_to(p, middle));
      uint parent;
      LOAD1(parent, collapses, 2u * texel);
      vec3 from = i < 2u ? a : (i == 4u ? c : b);
      vec3 to = i == 0u ? b : (i < 3u ? c : d);
      float apart = parent != texel ? 1.0f : 0.0f;
      own_error = max2(own_error, deviation(p, from, to) * apart);
      vec3 way = position_of(parent) - p;
      margin = max3(margin, vec3(abs1(way.x), abs1(way.y), abs1(way.z)));
    }
  }
  float finer_error = 0.0f;
  for (uint k = 0u; k < 4u; ++k) {
    if (has_child(node, k)) {
      NodeDetail child = load_detail(node.first_child + k);
      extent = max2(extent, distance_to(child.middle, middle) + child.extent);
      finer_error = max2(finer_error, child.whole);
    }
  }
  float error = max2((own_error + finer_error) * detail_slack, least_radius);
  for (uint i = 0u; i < 5u; ++i) {
    uint texel = between_corners(node, i);
    if (texel != no_index) {
      uint point;
      LOAD1(point, points, texel);
      RAISE(point, error);
    }
  }
  STORE4(node_details, 2u * node.node, as_bits(middle, floatBitsToUint(extent * detail_slack)));
  STORE4(node_details, 2u * node.node + 1u,
         settled_bits(error, fixed_radius, flush_tiny3(margin * detail_slack)));
}

// From which tolerances on it is one quad and what is between its corners slides; and the least that the
// radii of the corners can be.
FN void settle_node(uint index, float steepest) {
  CoarseNode node = load_coarse_node(index);
  float largest = 0.0f;
  float smallest = fixed_radius;
  for (uint i = 0u; i < 5u; ++i) {
    uint texel = between_corners(node, i);
    if (texel != no_index) {
      uint point;
      LOAD1(point, points, texel);
      float radius = RADIUS(point);
      largest = max2(largest, radius);
      smallest = min2(smallest, radius);
    }
  }
  float whole = (node.flags & coarse_whole) != 0u ? whole_from(largest) : fixed_radius;
  for (uint k = 0u; k < 4u; ++k)
    if (has_child(node, k)) whole = max2(whole, load_detail(node.first_child + k).whole);
  NodeDetail detail = load_detail(node.node);
  float radius = corner_radius(whole, detail.extent, steepest);
  for (uint i = 0u; i < 4u; ++i) {
    uint texel = node.texel + ((i & 1u) != 0u ? node.across : 0u) + (i >= 2u ? node.along : 0u);
    uint point;
    LOAD1(point, points, texel);
    RAISE(point, radius);
  }
  STORE4(node_details, 2u * node.node + 1u, settled_bits(whole, smallest, detail.margin));
}
