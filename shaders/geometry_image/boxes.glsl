// SPDX-License-Identifier: MIT
// What the passes that make records of boxes share. Before this come the buffer `boxes` and the push constants.

void store_record(uint depth, uint index, Box c0, Box c1, Box c2, Box c3) {
  uint record = 3u * (push.first_node + level_base(depth) + index);
  STORE4(boxes, record, pack_planes(c0.lo.x, c1.lo.x, c2.lo.x, c3.lo.x, c0.hi.x, c1.hi.x, c2.hi.x, c3.hi.x));
  STORE4(boxes, record + 1u, pack_planes(c0.lo.y, c1.lo.y, c2.lo.y, c3.lo.y, c0.hi.y, c1.hi.y, c2.hi.y, c3.hi.y));
  STORE4(boxes, record + 2u, pack_planes(c0.lo.z, c1.lo.z, c2.lo.z, c3.lo.z, c0.hi.z, c1.hi.z, c2.hi.z, c3.hi.z));
}
