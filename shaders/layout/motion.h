// SPDX-License-Identifier: MIT
// Motion blur. The shutter opens at time 0 and closes at 1. The geometry image is made at the ends of
// `segments` equal stretches of it, one image behind the other, and within a stretch every texel moves along
// a straight line. Each stretch has a hierarchy of its own, whose bounds hold the quads of both images and
// so, by the rounding below, those at any time between: a ray goes through the hierarchy of the stretch that
// its time lies in, and is tested against quads as they are at its time.
#ifndef LODESTONE_LAYOUT_MOTION_H
#define LODESTONE_LAYOUT_MOTION_H

#include "layout/arithmetic.h"

LODESTONE_LAYOUT_BEGIN

CONST uint most_segments = 64u;

struct Moment {
  uvec1 segment;
  vec1 fraction;  // of it that has passed, in [0, 1]
};

// `time` in [0, 1].
FN Moment moment_of(vec1 time, uint segments) {
  vec1 scaled = time * float(segments);
  uvec1 last = uvec1(segments - 1u);
  Moment moment;
  moment.segment = uvec1(scaled);
  moment.segment = select(moment.segment < last, moment.segment, last);
  moment.fraction = saturate(scaled - vec1(moment.segment));
  return moment;
}

// Never outside the interval from a to b, whatever the rounding.
FN vec1 moved1(vec1 a, vec1 b, vec1 fraction) {
  return clamp1(a + (b - a) * fraction, min2(a, b), max2(a, b));
}
FN vec3 moved3(vec3 a, vec3 b, vec1 fraction) {
  return flush_tiny3(
      vec3(moved1(a.x, b.x, fraction), moved1(a.y, b.y, fraction), moved1(a.z, b.z, fraction)));
}

LODESTONE_LAYOUT_END
#endif
