// SPDX-License-Identifier: MIT
// Light and material: the metallic-roughness model of glTF 2.0 (appendix B) with GGX, direct light only. Of
// KHR_materials_ior, specular and clearcoat what reflects; of KHR_materials_transmission that what passes
// through is not scattered back.
#ifndef LODESTONE_LAYOUT_SHADING_H
#define LODESTONE_LAYOUT_SHADING_H

#include "layout/arithmetic.h"
#include "layout/atlas.h"
#include "layout/frame.h"
#include "layout/ray.h"
#include "layout/sampling.h"

LODESTONE_LAYOUT_BEGIN

// Pixel of ray `ray`; false where it lies outside the picture.
FN bvec1 ray_pixel(uvec1 ray, uint width, uint height, OUT(uvec1) x, OUT(uvec1) y) {
  uvec1 tile = ray >> 6u;
  uint tiles = tile_count(width);
  x = (tile % tiles) * 8u + gather_bits(ray & 63u);
  y = (tile / tiles) * 8u + gather_bits((ray & 63u) >> 1u);
  return x < width && y < height;
}

// One texel coordinate and the weight of the next one, along one axis of a bilinear look-up.
FN uvec1 wrap_texel(ivec1 i, int size, uint wrap) {
  if (wrap == wrap_clamp) return uvec1(select(i < 0, 0, select(i >= size, size - 1, i)));
  int period = wrap == wrap_mirror ? 2 * size : size;
  ivec1 m = i % period;
  m = select(m < 0, m + period, m);
  return uvec1(select(m >= size, period - 1 - m, m));
}

struct TexelPair {
  uvec1 first;
  uvec1 second;
  vec1 weight;  // of the second
};

FN TexelPair texel_pair(vec1 coordinate, uint size, uint wrap, uint nearest) {
  // Beyond some thousand repeats a float has no fraction left; fold first, so that the integer part stays
  // small.
  vec1 folded =
      wrap == wrap_clamp ? clamp1(coordinate, -1.0f, 2.0f) : coordinate - 2.0f * floor(coordinate * 0.5f);
  vec1 x = folded * float(size) - (nearest != 0u ? 0.0f : 0.5f);
  vec1 whole = floor(x);
  ivec1 i = ivec1(whole);
  TexelPair pair;
  pair.first = wrap_texel(i, int(size), wrap);
  pair.second = wrap_texel(i + 1, int(size), wrap);
  pair.weight = nearest != 0u ? 0.0f : x - whole;
  return pair;
}

FN vec2 transform_texcoord(IN(TextureRecord) texture_record, vec2 uv) {
  return vec2(texture_record.u_row.x * uv.x + texture_record.u_row.y * uv.y + texture_record.u_row.z,
              texture_record.v_row.x * uv.x + texture_record.v_row.y * uv.y + texture_record.v_row.z);
}

FN vec4 unpack_rgba8(uvec1 rgba) {
  return vec4(vec1(rgba & 255u), vec1((rgba >> 8u) & 255u), vec1((rgba >> 16u) & 255u), vec1(rgba >> 24u)) /
         255.0f;
}

// A vertex colour as stored: the square roots of R, G and B, which keeps dark tones apart, and A.
FN vec4 unpack_vertex_color(uvec1 rgba) {
  vec4 c = unpack_rgba8(rgba);
  return vec4(c.x * c.x, c.y * c.y, c.z * c.z, c.w);
}

FN vec3 sky_radiance(IN(FrameRecord) frame, vec3 direction) {
  vec1 up = clamp1(direction.y, -1.0f, 1.0f);
  vec3 far = select(up >= 0.0f, vec3(frame.sky_top), vec3(frame.sky_bottom));
  // The horizon is a narrow band: blend by the square root of the height.
  return mix3(frame.sky_horizon, far, sqrt(abs1(up)));
}

struct Surface {
  vec3 position;
  vec1 reach;      // the largest number in its rounding: a coordinate, or the way to a corner of its triangle
  vec3 geometric;  // unit normals, turned to the viewer
  vec3 normal;
  vec3 view;  // to the viewer, unit length
  vec3 albedo;
  vec3 emission;
  vec1 alpha;
  vec1 metallic;
  vec1 roughness;
  vec1 occlusion;
  vec2 texcoord;
  // Of the dielectric part: reflectance straight on and at grazing angles.
  vec3 f0;
  vec1 f90;
  vec1 ior;
  vec1 transmission;  // share of the light that enters that passes through
  bvec1 solid;        // refracts; else a thin wall
  bvec1 inside;       // the ray came from within: from the side that the vertices' normals point away from
  vec3 attenuation;   // of the solid: exp(-attenuation * length) passes
  vec1 clearcoat;
  vec1 clearcoat_roughness;
  vec3 clearcoat_normal;  // unit length, turned to the viewer
};

// A dielectric of an ior of 1.5 that nothing passes through, without a coat.
FN void make_plain(INOUT(Surface) s) {
  s.f0 = vec3(0.04f, 0.04f, 0.04f);
  s.f90 = 1.0f;
  s.ior = 1.5f;
  s.transmission = 0.0f;
  s.solid = false;
  s.inside = false;
  s.attenuation = vec3(0.0f, 0.0f, 0.0f);
  s.clearcoat = 0.0f;
  s.clearcoat_roughness = 0.0f;
  s.clearcoat_normal = s.normal;
}

FN vec1 fresnel_power(vec1 cosine) {
  vec1 x = saturate(1.0f - cosine);
  vec1 x2 = x * x;
  return x2 * x2 * x;
}

// Reflectance straight on, and at grazing angles.
FN vec3 specular_color(IN(Surface) s) {
  return mix3(s.f0, s.albedo, s.metallic);
}
FN vec1 grazing_reflectance(IN(Surface) s) {
  return 1.0f - (1.0f - s.f90) * (1.0f - s.metallic);  // exactly 1 where f90 is
}
FN vec3 diffuse_color(IN(Surface) s) {
  return s.albedo * (1.0f - s.metallic) * (1.0f - s.transmission);
}

// GGX: the distribution of microfacets times their shadowing and masking over 4 n_l n_v; cosines above 0.
FN vec1 microfacets(vec1 roughness, vec1 n_l, vec1 n_v, vec1 n_h) {
  vec1 alpha = max2(roughness * roughness, 1e-3f);
  vec1 alpha2 = alpha * alpha;
  vec1 d_term = n_h * n_h * (alpha2 - 1.0f) + 1.0f;
  vec1 distribution = alpha2 / (pi * d_term * d_term);
  vec1 masking = 0.5f / (n_l * sqrt(n_v * n_v * (1.0f - alpha2) + alpha2) +
                         n_v * sqrt(n_l * n_l * (1.0f - alpha2) + alpha2));
  return distribution * masking;
}

// How much of what a mirror lobe would show, of the sky and of lights of one direction, is left to rays that
// go on from the surface.
struct Traced {
  vec1 base_sky;
  vec1 base_lights;
  vec1 coat_sky;
  vec1 coat_lights;
};

FN Traced nothing_traced() {
  Traced traced;
  traced.base_sky = 0.0f;
  traced.base_lights = 0.0f;
  traced.coat_sky = 0.0f;
  traced.coat_lights = 0.0f;
  return traced;
}

// Below the coat.
FN vec3 base_reflected(IN(Surface) s, vec3 to_light, vec1 highlight) {
  vec1 n_l = dot3(s.normal, to_light);
  bvec1 lit = n_l > 0.0f;
  if (!any_lane(lit)) return vec3(0.0f, 0.0f, 0.0f);
  vec1 n_v = max2(dot3(s.normal, s.view), 1e-4f);
  vec3 half_way = normalize_or(to_light + s.view, s.normal);
  vec1 n_h = saturate(dot3(s.normal, half_way));
  vec1 v_h = saturate(dot3(s.view, half_way));
  vec3 f0 = specular_color(s);
  vec1 f90 = grazing_reflectance(s);
  vec3 fresnel = f0 + (vec3(f90, f90, f90) - f0) * fresnel_power(v_h);
  vec3 diffuse = diffuse_color(s) * (vec3(1.0f, 1.0f, 1.0f) - fresnel) * (1.0f / pi);
  vec3 sent = (diffuse + fresnel * (microfacets(s.roughness, n_l, n_v, n_h) * highlight)) * n_l;
  return select(lit, sent, vec3(0.0f, 0.0f, 0.0f));
}

// What is seen of `base` below the coat and of `coat`, light that the coat sends were it a mirror
// (KHR_materials_clearcoat).
FN vec3 coated(IN(Surface) s, vec3 base, vec3 coat) {
  vec1 facing = abs1(dot3(s.clearcoat_normal, s.view));
  vec1 share = s.clearcoat * (0.04f + 0.96f * fresnel_power(facing));
  return select(s.clearcoat > 0.0f, mix3(base, coat, share), base);
}

// The BRDF times the cosine, for light from `to_light` (unit length). Nothing of what passes through.
FN vec3 reflected(IN(Surface) s, vec3 to_light, IN(Traced) traced) {
  vec3 base = base_reflected(s, to_light, 1.0f - traced.base_lights);
  if (!any_lane(s.clearcoat > 0.0f)) return base;
  vec1 n_l = dot3(s.clearcoat_normal, to_light);
  vec1 n_v = max2(dot3(s.clearcoat_normal, s.view), 1e-4f);
  vec3 half_way = normalize_or(to_light + s.view, s.clearcoat_normal);
  vec1 n_h = saturate(dot3(s.clearcoat_normal, half_way));
  vec1 coat = select(n_l > 0.0f, microfacets(s.clearcoat_roughness, n_l, n_v, n_h) * n_l, 0.0f);
  coat = coat * (1.0f - traced.coat_lights);
  return coated(s, base, vec3(coat, coat, coat));
}

// What the surface sends to the viewer by itself.
FN vec3 emitted_radiance(IN(Surface) s) {
  if (!any_lane(s.clearcoat > 0.0f)) return s.emission;
  return coated(s, s.emission, vec3(0.0f, 0.0f, 0.0f));
}

// Two unit vectors that make a frame with `axis` (Duff et al. 2017, "Building an orthonormal basis,
// revisited").
FN void orthonormal_basis(vec3 axis, OUT(vec3) tangent, OUT(vec3) bitangent) {
  vec1 side = select(axis.z < 0.0f, -1.0f, 1.0f);
  vec1 p = -1.0f / (side + axis.z);
  vec1 q = axis.x * axis.y * p;
  tangent = vec3(1.0f + side * axis.x * axis.x * p, side * q, -side * axis.x);
  bitangent = vec3(q, side + axis.y * axis.y * p, -axis.y);
}

// A point of the unit disc, uniformly distributed (Shirley and Chiu's concentric map).
FN vec2 concentric_disc(vec2 xi) {
  vec1 x = 2.0f * xi.x - 1.0f;
  vec1 y = 2.0f * xi.y - 1.0f;
  bvec1 wide = abs1(x) > abs1(y);
  vec1 radius = select(wide, x, y);
  vec1 ratio = select(radius == 0.0f, 0.0f, select(wide, y, x) / radius);
  vec2 turn = cos_sin_turns(select(wide, ratio * 0.125f, 0.25f - ratio * 0.125f));
  return vec2(radius * turn.x, radius * turn.y);
}

// A direction around `axis`, cosine-distributed (Malley).
FN vec3 cosine_direction(vec3 axis, vec2 xi) {
  vec2 disc = concentric_disc(xi);
  vec1 height = sqrt(max2(1.0f - disc.x * disc.x - disc.y * disc.y, 0.0f));
  vec3 tangent;
  vec3 bitangent;
  orthonormal_basis(axis, tangent, bitangent);
  return normalize_or(tangent * disc.x + bitangent * disc.y + axis * height, axis);
}

// The share of a sky of radiance 1 that the rough mirror part sends back (Karis 2014, "Physically based
// shading on mobile", a fit of the split-sum table).
FN vec3 sky_specular(IN(Surface) s) {
  vec1 n_v = saturate(dot3(s.normal, s.view));
  vec1 r = s.roughness;
  vec1 r0 = 1.0f - r;
  vec1 r1 = 0.0425f - 0.0275f * r;
  vec1 r2 = 1.04f - 0.572f * r;
  vec1 r3 = -0.04f + 0.022f * r;
  vec1 a004 = min2(r0 * r0, exp2_(-9.28f * n_v)) * r0 + r1;
  vec1 scale = -1.04f * a004 + r2;
  vec1 bias = 1.04f * a004 + r3;
  vec1 edge = bias * grazing_reflectance(s);
  vec3 color = specular_color(s) * scale + vec3(edge, edge, edge);
  return max3(color, vec3(0.0f, 0.0f, 0.0f));
}

// What arrives at a point from a light that has one direction.
struct Arrival {
  vec3 direction;  // unit length, to the light
  vec1 distance;   // to where the shadow ray ends
  vec1 falloff;    // times the light's colour: irradiance across the direction
};

FN Arrival arriving_light(IN(LightRecord) light, vec3 position, vec3 fallback) {
  Arrival result;
  result.distance = 1e30f;
  result.falloff = 1.0f;
  if (light.kind == light_directional) {
    result.direction = light.direction * -1.0f;
  } else {
    vec3 to_light = light.position - position;
    vec1 distance2 = dot3(to_light, to_light);
    vec1 distance = sqrt(distance2);
    result.direction = normalize_or(to_light, fallback);
    result.distance = distance;
    result.falloff = 1.0f / max2(distance2, 1e-8f);
    if (light.range > 0.0f) {  // the window that KHR_lights_punctual recommends
      vec1 x = distance / light.range;
      vec1 x2 = x * x;
      result.falloff = result.falloff * saturate(1.0f - x2 * x2);
    }
    if (light.kind == light_spot) {
      vec1 cone = saturate(-dot3(light.direction, result.direction) * light.cone_scale + light.cone_offset);
      result.falloff = result.falloff * cone * cone;
    }
  }
  return result;
}

struct LightSample {
  vec3 direction;  // unit length, from the surface
  vec1 distance;   // to where the shadow ray ends
  vec3 radiance;   // reflected towards the viewer if nothing is in the way
};

// Of any light but the sky (layout/sky_light.h).
FN LightSample sample_light(IN(LightRecord) light, IN(Surface) s, IN(Traced) traced) {
  LightSample result;
  Arrival arrival = arriving_light(light, s.position, s.normal);
  result.direction = arrival.direction;
  result.distance = arrival.distance;
  result.radiance = reflected(s, arrival.direction, traced) * light.color * arrival.falloff;
  return result;
}

// In parts of a surface's reach.
CONST float leaving_offset = 1.9073486e-6f;  // 2^-19

// A ray that leaves the surface on the side of the viewer (side 1) or on the other (-1), from beyond what
// rounding may have moved it. A position is off by less than 2^-21 of the surface's reach (three products and
// their sum, each by half an ulp), and so is the t that traversal finds for the triangle that it lies on.
// `distance`: where it ends, again before what rounding may have moved.
FN Ray leaving_ray(IN(Surface) s, vec3 direction, vec1 side, vec1 distance) {
  vec1 offset = s.reach * leaving_offset;
  Ray ray;
  ray.origin = flush_tiny3(s.position + s.geometric * (offset * side));
  ray.tmin = 0.0f;
  ray.direction = direction;
  ray.tmax = distance - 2.0f * offset;
  return ray;
}

// Exposure, then a filmic curve (the rational fit of the ACES curve by Narkowicz, 2016) or none, then the
// sRGB encoding.
FN vec3 display_color(IN(FrameRecord) frame, vec3 radiance) {
  vec3 x = max3(radiance * frame.exposure, vec3(0.0f, 0.0f, 0.0f));
  x = vec3(min2(x.x, 1e6f), min2(x.y, 1e6f), min2(x.z, 1e6f));
  if (frame.filmic != 0u) {
    vec3 y = x * 0.6f;  // the fit is 1/0.6 brighter than the curve it follows
    x = (y * (y * 2.51f + vec3(0.03f, 0.03f, 0.03f))) /
        (y * (y * 2.43f + vec3(0.59f, 0.59f, 0.59f)) + vec3(0.14f, 0.14f, 0.14f));
  }
  return vec3(linear_to_srgb(saturate(x.x)), linear_to_srgb(saturate(x.y)), linear_to_srgb(saturate(x.z)));
}

LODESTONE_LAYOUT_END
#endif
