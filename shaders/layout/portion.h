// SPDX-License-Identifier: MIT
// Rays through a scene that is larger than the device's memory: its surface comes in portions, one after the
// other, each a geometry image with a hierarchy of its own. What a ray has hit so far is carried from one to
// the next, and with it all that shading reads of the surface there, for the portion will be gone by then. It
// is kept as if every ray had a geometry image of its own: a chart of one quad, and the triangles that its
// texels sample.
#ifndef LODESTONE_LAYOUT_PORTION_H
#define LODESTONE_LAYOUT_PORTION_H

#include "layout/types.h"

LODESTONE_LAYOUT_BEGIN

// Of ray i what was found has: texels found_texels * i + 0..3 in a chart i, triangles s * i + 0..s - 1 where
// each texel of a mapped chart may sample one of its own (s is `sources` of layout/surface.h), and three
// vertices for each of these.
CONST uint found_texels = 4u;
CONST uint found_vertices = 3u;  // of a triangle

struct PortionPush {
  uint count;         // rays
  uint restarted;     // portion_begin: 1, only those that `mask` has sent on
  uint runs;          // texels that follow one another in the portion and in the whole; 0: portion_enter need
                      // not know, where no ray is one of those
  uint image_texels;  // where something moves (layout/motion.h): of a geometry image
  vec3 lo;            // a box round the portion
  float extent;       // ObjectRecord::extent
  vec3 hi;
};

LODESTONE_LAYOUT_END
#endif
