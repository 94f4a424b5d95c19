// SPDX-License-Identifier: MIT
// What the host uploads: once per scene the tables, once per frame camera and lights (and weights and
// matrices, see geometry_image/blend). Scalar layout: no padding but what is written here.
#ifndef LODESTONE_LAYOUT_FRAME_H
#define LODESTONE_LAYOUT_FRAME_H

#include "layout/types.h"

LODESTONE_LAYOUT_BEGIN

// The light from all directions that nothing blocks, as layout/environment.h finds and samples it.
struct EnvironmentRecord {
  uint width;  // texels; of the analytic sky those of the raster that its density comes from
  uint height;
  uint column_step;  // the greatest power of 2 below `width` (0: none): where a binary search begins ...
  uint row_step;     // ... and that below height + 1
  float turn;        // the column coordinate u, in [0, 1], of (1, 0, 0)
  uint pad0;
  uint pad1;
  uint pad2;
};

struct FrameRecord {
  vec3 origin;  // see render::View
  uint perspective;
  vec3 right;
  uint width;
  vec3 up;
  uint height;
  vec3 forward;
  uint seed;
  vec3 sky_top;
  uint spp;
  vec3 sky_horizon;
  uint filmic;
  vec3 sky_bottom;
  float exposure;   // 2^stops
  vec3 lens_right;  // half axes of the lens; 0: a pinhole
  float focus;      // along `forward`: where what lies is sharp
  vec3 lens_up;
  uint segments;           // of the shutter (layout/motion.h); 0: it is open for an instant
  uint image_texels;       // of one geometry image
  float tolerance;         // with levels of detail (layout/detail.h): the width of the cone at `origin` ...
  float tolerance_spread;  // ... and its spread
  float steepest;          // the most that any cone may widen a unit of length
  EnvironmentRecord environment;
};

CONST uint light_directional = 0u;
CONST uint light_point = 1u;
CONST uint light_spot = 2u;
CONST uint light_sky = 3u;
CONST uint light_emitters = 4u;  // all surfaces that shine (layout/emitters.h); the last one, of `path` alone

struct LightRecord {
  vec3 position;
  uint kind;
  vec3 direction;     // of the light's rays, unit length
  float range;        // 0: infinite
  vec3 color;         // times intensity
  float cone_scale;   // spot: 1 / (cos inner - cos outer) ...
  float cone_offset;  // ... and -cos outer times that
  // Of the integrator `path`, which draws one light at a time:
  uint first_number;  // of the numbers that draw it; they ascend with the lights
  uint numbers;       // how many these are; its chance is this over drawn_numbers
  uint pad0;
};

struct MaterialRecord {
  vec4 base_color;
  vec3 emissive;
  float metallic;
  float roughness;
  float normal_scale;
  float occlusion_strength;
  float alpha_cutoff;
  uint alpha_mask;
  uint base_color_texture;  // no_index: none
  uint metallic_roughness_texture;
  uint normal_texture;
  uint occlusion_texture;
  uint emissive_texture;
  // What follows is for kernels with `layered` (layout/surface.h).
  float ior;  // at most highest_ior
  float f0;   // reflectance straight on, by the ior
  vec3 specular_color;
  float specular;
  vec3 attenuation;  // absorbed per unit of length: exp(-attenuation * length) passes
  float transmission;
  float clearcoat;
  float clearcoat_roughness;
  float clearcoat_normal_scale;
  uint solid;  // 1: refracts, 0: a thin wall
  uint specular_texture;
  uint specular_color_texture;
  uint transmission_texture;
  uint clearcoat_texture;
  uint clearcoat_roughness_texture;
  uint clearcoat_normal_texture;
  uint pad0;
  uint pad1;
};

CONST float highest_ior = 1e6f;  // stands for an infinite one

// The image buffer begins with what each value of an sRGB channel is, linear (float bits).
CONST uint srgb_levels = 256u;

CONST uint wrap_repeat = 0u;
CONST uint wrap_clamp = 1u;
CONST uint wrap_mirror = 2u;

struct TextureRecord {
  uint first_texel;  // in the image buffer, behind the table of `srgb_levels`: RGBA8, R lowest
  uint width;
  uint height;
  uint texcoord;
  uint wrap_u;
  uint wrap_v;
  uint nearest;
  uint pad0;
  vec3 u_row;
  float pad1;
  vec3 v_row;
  float pad2;
};

// Where an object is in the world (layout/objects.h): seven quads.
CONST uint instance_quads = 7u;
struct InstanceRecord {
  vec4 to_object[3];  // rows of a 3 x 4 matrix
  vec4 to_world[3];
  uint object;
  uint node;       // of the scene; no_index: none
  float rounding;  // by how much rounding may grow on the way through both matrices, at least 1; negative:
                   // the matrix has no inverse, and the instance is not seen
  uint emitter_share;  // by how many numbers an emitter is drawn in it (layout/emitters.h)
};

struct PartRecord {
  uint material;
  uint mesh;
  uint first_triangle;
  uint first_mesh_triangle;
};

// 2^24 numbers, as many as a random number in [0, 1) has, are shared out among what is to be drawn.
CONST float drawn_numbers = 16777216.0f;

// Rays are numbered in tiles of 8 x 8 pixels, Morton order within a tile, so that neighbours in a subgroup
// are neighbours in the picture.
struct RayPush {
  uint first_ray;  // of the batch
  uint rays;
  uint sample_index;
  uint centered;  // 1: through pixel centres
  uint pinhole;   // 1: through the middle of the lens
  uint light;
  uint first;        // 1: the pass starts a sum, 0: it adds to one
  uint vertex;       // surfaces that the longest of the batch's rays came by
  uint last_vertex;  // from which nothing goes on
  uint instant;      // 1: in the middle of the time that the shutter is open, not anywhere in it
};

// Ambient occlusion of a batch.
struct AmbientPush {
  uint first_ray;
  uint rays;
  uint sample_index;
  uint first;      // 1: the pass starts a sum, 0: it adds to one
  float distance;  // beyond which nothing occludes
};

// One vertex of each path of a batch, or of what else goes from surface to surface.
struct PathPush {
  uint first_ray;
  uint rays;
  uint sample_index;
  uint vertex;       // 0: where the camera's ray ends
  uint last_vertex;  // from which nothing goes on
  uint lights;
  uint light_step;       // where a binary search among them begins (EnvironmentRecord)
  uint first;            // 1: the pass starts a sum, 0: it adds to one
  float sky_chance;      // of the sky to be drawn ...
  float emitter_chance;  // ... and of the emitters; 0 where there are none
};

struct ResolvePush {
  uint first_ray;
  uint rays;
};

struct BlendPush {
  uint first;
  uint vertices;
  uint tangents;  // 1: there are some
};

struct CountPush {
  uint count;
};

struct RasterisePush {
  uint first;
  uint count;
  uint image;  // first texel of the geometry image to write
};
struct BoundsPush {
  uint depth;          // of the nodes that are read: the leaves, or a level above
  uint count;          // places on that level that may be read
  uint written;        // places of the next level to write ...
  uint written_above;  // ... and of the one above that
  uint first_node;     // of the hierarchy
  uint first_slot;
  uint image;       // first texel of the geometry image, and ...
  uint next_image;  // ... of the one behind, where something moves
};

FN uint tile_count(uint size) {
  return (size + 7u) / 8u;
}

LODESTONE_LAYOUT_END
#endif
