// SPDX-License-Identifier: MIT
// The built-in scenes, one function each; make_builtin (load.h) names and validates them.
#pragma once

#include "lodestone/scene/scene.h"

namespace lodestone::scene::builtin {

// A cartoon bust with 18 blendshapes, about 65,000 vertices; clip `Expressions`, camera `Portrait`.
Scene make_head();
// A closed room lit by surfaces that shine, one of which swings in clip `Swing`, and a candle; camera `Door`.
Scene make_room();
// Ten thousand fish of three meshes that circle above the sea floor in clip `Circle`, cameras `ball` and
// `among`; 7.4 million triangles, most of them instances.
Scene make_shoal();
// A floor and closed spheres of several materials, lights of every kind, one blendshape; 10,000 triangles.
Scene make_spheres();
// Three Utah teapots on an island with palms, cameras `teapots`, `island` and `handle`; 98,000 triangles,
// rigid nodes that turn in clip `Turn`.
Scene make_teapots();
// A fractal height field of charts of unequal odd sizes with a moving wave; 40,000 triangles.
Scene make_terrain();
// Its mountains in so many quads a side, at rest, in charts of at most 1024.
Scene make_large_terrain(uint32_t quads);
inline constexpr uint32_t least_terrain = 16, largest_terrain = 8192;
// Two grids with a handful of triangles and one blendshape.
Scene make_tiny();

}  // namespace lodestone::scene::builtin
