// SPDX-License-Identifier: MIT
// The buffers that surface.h reads: slots 0 to 15 of `mask`, `shade` and `aov`.
#include "kernel.glsl"
#include "layout/shading.h"
#include "layout/trace.h"

QUADS(0, readonly, hits);
QUADS(1, readonly, geometry);
QUADS(2, readonly, normal_map);
QUADS(3, readonly, texel_map);
QUADS(4, readonly, triangles);
QUADS(5, readonly, positions);
QUADS(6, readonly, normals);
QUADS(7, readonly, tangents);
QUADS(8, readonly, texcoords);
WORDS(9, readonly, images);
WORDS(10, readonly, srgb_table);
QUADS(11, readonly, charts);
STRUCTS(12, readonly, PartRecord, parts);
STRUCTS(13, readonly, MaterialRecord, materials);
STRUCTS(14, readonly, TextureRecord, textures);
STRUCTS(15, readonly, FrameRecord, frames);

layout(constant_id = 2) const uint sources = 1u;
layout(constant_id = 3) const uint layered = 0u;

#define WHERE(condition) if (condition)
#define SET(variable, value) variable = value
#include "layout/surface.h"
