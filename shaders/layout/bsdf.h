// SPDX-License-Identifier: MIT
// How a surface scatters light, to be evaluated and sampled: the metallic-roughness model of glTF 2.0
// (appendix B) with KHR_materials_transmission and KHR_materials_clearcoat. Rough lobes are GGX with the
// height-correlated masking of Smith, sampled by visible normals (Dupuy and Benyoub 2023, "Sampling visible
// GGX normals with spherical caps"); rough refraction is that of Walter et al. 2007. A lobe whose alpha is
// below smallest_alpha is a perfect mirror: it is in no value and no density, only samples show it.
#ifndef LODESTONE_LAYOUT_BSDF_H
#define LODESTONE_LAYOUT_BSDF_H

#include "layout/shading.h"

LODESTONE_LAYOUT_BEGIN

CONST float smallest_alpha = 1e-3f;

struct Bsdf {
  vec3 geometric;  // unit normals, all on the viewer's side
  vec3 normal;
  vec3 coat_normal;
  vec3 view;         // to the viewer, unit length
  vec3 diffuse;      // albedo of the diffuse lobe, of all the light that arrives
  vec3 specular;     // reflectance at normal incidence ...
  vec1 grazing;      // ... and at grazing angles
  vec3 transmitted;  // what a lobe through the surface lets through of what is not reflected
  vec1 alpha;        // GGX, of reflection and transmission
  vec1 coat;         // share of the surface that is coated
  vec1 coat_alpha;   // GGX
  vec1 eta;          // refractive index on the viewer's side over that on the other
  bvec1 solid;       // light through it is refracted; else it is a thin wall, which light passes straight
  bool layered;      // the same everywhere: whether there are coats and transmission to look at
  vec1 base;         // what the coat leaves to the lobes below
  vec1 chance_coat;  // of each lobe to be sampled; they add up to 1
  vec1 chance_specular;
  vec1 chance_transmitted;
};

// Schlick's approximation by the cosine on the side where the angle is larger, so that it holds from both
// sides; 1 beyond the critical angle.
FN vec3 interface_fresnel(IN(Bsdf) b, vec1 cosine) {
  vec1 beyond = b.eta * b.eta * (1.0f - cosine * cosine);
  vec1 refracted = sqrt(max2(1.0f - beyond, 0.0f));
  vec1 c = select(b.solid && b.eta > 1.0f, refracted, cosine);
  return b.specular + (vec3(b.grazing, b.grazing, b.grazing) - b.specular) * fresnel_power(c);
}
FN vec1 coat_fresnel(vec1 cosine) {
  return 0.04f + 0.96f * fresnel_power(cosine);
}

// From the lobes that it names to the chances of each, by how much of the viewer's direction they reflect.
FN Bsdf with_chances(Bsdf b) {
  vec1 coat = 0.0f;
  if (b.layered) coat = b.coat * coat_fresnel(saturate(dot3(b.coat_normal, b.view)));
  b.base = 1.0f - coat;
  vec1 reflected_share = luminance(interface_fresnel(b, saturate(dot3(b.normal, b.view))));
  // Facets of a rough surface let light through where its middle would not.
  reflected_share = select(b.alpha < smallest_alpha, reflected_share, min2(reflected_share, 0.9f));
  vec1 specular = b.base * reflected_share;
  vec1 through = b.base * (1.0f - reflected_share);
  vec1 transmitted = through * luminance(b.transmitted);
  vec1 sum = coat + specular + transmitted + b.base * luminance(b.diffuse);
  vec1 scale = select(sum > 1e-6f, 1.0f / sum, vec1(0.0f));
  b.chance_coat = coat * scale;
  b.chance_specular = specular * scale;
  b.chance_transmitted = transmitted * scale;
  return b;
}

// A normal map, or the normals of a coarse mesh at its silhouette, may turn a normal away from the viewer,
// who would see nothing reflected then.
FN vec3 visible_normal(IN(Surface) s, vec3 normal) {
  vec1 n_v = dot3(normal, s.view);
  vec3 turned = normalize_or(normal + s.view * (1e-3f - n_v), s.geometric);
  return select(n_v < 1e-3f, turned, normal);
}

// What is left of light that came `distance` through the solid, where the ray came from within one.
FN vec3 transmittance(IN(Surface) s, vec1 distance) {
  vec3 depth = s.attenuation * (distance * -1.44269504f);
  vec3 left = vec3(exp2_(depth.x), exp2_(depth.y), exp2_(depth.z));
  return select(s.solid && s.inside, left, vec3(1.0f, 1.0f, 1.0f));
}

// Of a surface whose normals are on the viewer's side.
FN Bsdf surface_bsdf(IN(Surface) s, bool layered) {
  Bsdf b;
  b.geometric = s.geometric;
  b.view = s.view;
  b.normal = visible_normal(s, s.normal);
  // What the mirror lobe reflects in all directions does not reach the diffuse one. (glTF's factor, 1 minus
  // Fresnel by the half vector, would give more light back than there is, at grazing angles nearly twice.)
  b.diffuse = diffuse_color(s) * max3(vec3(1.0f, 1.0f, 1.0f) - sky_specular(s), vec3(0.0f, 0.0f, 0.0f));
  b.specular = specular_color(s);
  b.grazing = grazing_reflectance(s);
  b.transmitted = s.albedo * ((1.0f - s.metallic) * s.transmission);
  b.alpha = s.roughness * s.roughness;
  b.coat = s.clearcoat;
  b.coat_alpha = s.clearcoat_roughness * s.clearcoat_roughness;
  b.coat_normal = visible_normal(s, s.clearcoat_normal);
  b.eta = select(s.inside, s.ior, 1.0f / s.ior);
  b.solid = s.solid;
  b.layered = layered;
  return with_chances(b);
}

// Smith's Lambda by the cosine to the normal, which is not 0.
FN vec1 ggx_lambda(vec1 cosine, vec1 alpha) {
  vec1 c2 = cosine * cosine;
  vec1 tangent2 = max2(1.0f - c2, 0.0f) / c2;
  return 0.5f * (sqrt(1.0f + alpha * alpha * tangent2) - 1.0f);
}
// The distribution of microfacet normals. By the sine: 1 - cosine^2 has no digits left where alpha is small.
FN vec1 ggx_distribution(vec3 normal, vec3 facet, vec1 alpha) {
  vec3 across = cross3(normal, facet);
  vec1 cosine = dot3(normal, facet);
  vec1 a2 = alpha * alpha;
  vec1 denominator = cosine * cosine * a2 + dot3(across, across);
  return a2 / (pi * denominator * denominator);
}

// A microfacet normal as the viewer sees them, on the side of `normal`.
FN vec3 visible_facet(vec3 normal, vec3 view, vec1 alpha, vec2 xi) {
  vec3 tangent;
  vec3 bitangent;
  orthonormal_basis(normal, tangent, bitangent);
  vec3 upright = vec3(0.0f, 0.0f, 1.0f);
  vec3 stretched = normalize_or(
      vec3(dot3(tangent, view) * alpha, dot3(bitangent, view) * alpha, max2(dot3(normal, view), 0.0f)),
      upright);
  vec1 z = (1.0f - xi.y) * (1.0f + stretched.z) - stretched.z;
  vec1 radius = sqrt(max2(1.0f - z * z, 0.0f));
  vec2 turn = cos_sin_turns(xi.x);
  vec3 cap = vec3(radius * turn.x, radius * turn.y, z) + stretched;
  vec3 facet = normalize_or(vec3(cap.x * alpha, cap.y * alpha, max2(cap.z, 0.0f)), upright);
  return normalize_or(tangent * facet.x + bitangent * facet.y + normal * facet.z, normal);
}

// f times the cosine, and the density with which sample_bsdf draws `direction` (per solid angle).
struct BsdfValue {
  vec3 value;
  vec1 density;
};

// Density of the direction that a visible facet reflects to, and the share of it that is not masked.
struct GgxReflection {
  vec1 density;
  vec1 unmasked;
  vec1 view_facet;  // cosine
};

FN GgxReflection ggx_reflection(vec3 normal, vec3 view, vec3 direction, vec1 alpha) {
  vec1 n_v = max2(dot3(normal, view), 1e-4f);
  vec1 n_l = max2(dot3(normal, direction), 1e-4f);
  vec3 facet = normalize_or(direction + view, normal);
  vec1 lambda_view = ggx_lambda(n_v, alpha);
  GgxReflection result;
  result.density = ggx_distribution(normal, facet, alpha) / (4.0f * n_v * (1.0f + lambda_view));
  result.unmasked = (1.0f + lambda_view) / (1.0f + lambda_view + ggx_lambda(n_l, alpha));
  result.view_facet = saturate(dot3(view, facet));
  return result;
}

// The same of a direction on the other side, straight through a thin wall or refracted.
FN GgxReflection ggx_transmission(IN(Bsdf) b, vec3 direction) {
  vec1 n_l = -dot3(b.normal, direction);
  GgxReflection thin =
      ggx_reflection(b.normal, b.view, direction + b.normal * (2.0f * n_l), max2(b.alpha, smallest_alpha));
  vec1 alpha = max2(b.alpha, smallest_alpha);
  vec3 facet = normalize_or(b.view * b.eta + direction, b.normal);
  facet = select(dot3(facet, b.normal) < 0.0f, facet * -1.0f, facet);
  vec1 v_h = dot3(b.view, facet);
  vec1 l_h = dot3(direction, facet);
  vec1 n_v = max2(dot3(b.normal, b.view), 1e-4f);
  vec1 lambda_view = ggx_lambda(n_v, alpha);
  vec1 stretch = b.eta * v_h + l_h;
  vec1 density = ggx_distribution(b.normal, facet, alpha) * v_h * -l_h /
                 (n_v * (1.0f + lambda_view) * max2(stretch * stretch, 1e-12f));
  GgxReflection result;
  result.density = select(b.solid, select(v_h > 0.0f && l_h < 0.0f, density, vec1(0.0f)), thin.density);
  result.unmasked =
      select(b.solid, (1.0f + lambda_view) / (1.0f + lambda_view + ggx_lambda(max2(n_l, 1e-4f), alpha)),
             thin.unmasked);
  result.view_facet = select(b.solid, saturate(v_h), thin.view_facet);
  return result;
}

FN BsdfValue bsdf_value(IN(Bsdf) b, vec3 direction) {
  vec3 zero = vec3(0.0f, 0.0f, 0.0f);
  vec3 one = vec3(1.0f, 1.0f, 1.0f);
  vec1 n_l = dot3(b.normal, direction);
  vec1 g_l = dot3(b.geometric, direction);
  bvec1 above = n_l > 0.0f && g_l > 0.0f;
  bvec1 below = n_l < 0.0f && g_l < 0.0f;
  bvec1 rough = !(b.alpha < smallest_alpha);

  GgxReflection specular = ggx_reflection(b.normal, b.view, direction, max2(b.alpha, smallest_alpha));
  vec3 fresnel = interface_fresnel(b, specular.view_facet);
  vec1 chance_diffuse = 1.0f - b.chance_coat - b.chance_specular - b.chance_transmitted;
  vec1 cosine = max2(n_l, 0.0f) * (1.0f / pi);
  vec1 specular_density = select(rough, specular.density, vec1(0.0f));
  vec3 value = b.diffuse * (cosine * b.base) + fresnel * (specular_density * specular.unmasked * b.base);
  vec1 density = chance_diffuse * cosine + b.chance_specular * specular_density;

  vec3 through = zero;
  vec1 through_density = 0.0f;
  if (b.layered) {
    GgxReflection coat = ggx_reflection(b.coat_normal, b.view, direction, max2(b.coat_alpha, smallest_alpha));
    bvec1 coated = !(b.coat_alpha < smallest_alpha) && dot3(b.coat_normal, direction) > 0.0f;
    vec1 coat_density = select(coated, coat.density, vec1(0.0f));
    vec1 coat_value = b.coat * coat_fresnel(coat.view_facet) * coat_density * coat.unmasked;
    value = value + vec3(coat_value, coat_value, coat_value);
    density = density + b.chance_coat * coat_density;

    GgxReflection passed = ggx_transmission(b, direction);
    vec1 passed_density = select(rough && below, passed.density, vec1(0.0f));
    through = b.transmitted * (one - interface_fresnel(b, passed.view_facet)) *
              (passed_density * passed.unmasked * b.base);
    through_density = b.chance_transmitted * passed_density;
  }

  BsdfValue result;
  result.value = select(above, value, select(below, through, zero));
  result.density = select(above, density, select(below, through_density, vec1(0.0f)));
  return result;
}

struct BsdfSample {
  vec3 direction;  // unit length
  vec3 weight;     // f times the cosine over the density; 0: absorbed
  vec1 density;    // that of bsdf_value; 0: by a perfect mirror
  bvec1 through;   // it leaves on the other side
};

// `lobe` and `xi`: random numbers.
FN BsdfSample sample_bsdf(IN(Bsdf) b, vec1 lobe, vec2 xi) {
  vec3 zero = vec3(0.0f, 0.0f, 0.0f);
  vec3 one = vec3(1.0f, 1.0f, 1.0f);
  vec1 below_specular = b.chance_coat + b.chance_specular;
  vec1 below_diffuse = below_specular + b.chance_transmitted;
  bvec1 of_coat = lobe < b.chance_coat;
  bvec1 of_specular = !of_coat && lobe < below_specular;
  bvec1 of_through = !of_coat && !of_specular && lobe < below_diffuse;
  bvec1 of_diffuse = !(lobe < below_diffuse);
  vec3 axis = select(of_coat, b.coat_normal, b.normal);
  vec1 alpha = select(of_coat, b.coat_alpha, b.alpha);
  bvec1 mirror = !of_diffuse && alpha < smallest_alpha;
  vec3 facet = select(mirror, axis, visible_facet(axis, b.view, max2(alpha, smallest_alpha), xi));

  vec1 v_h = max2(dot3(b.view, facet), 0.0f);
  vec3 mirrored = facet * (2.0f * v_h) - b.view;
  vec3 straight = mirrored - b.normal * (2.0f * dot3(b.normal, mirrored));
  vec1 cosine2 = 1.0f - b.eta * b.eta * (1.0f - v_h * v_h);
  vec3 refracted = facet * (b.eta * v_h - sqrt(max2(cosine2, 0.0f))) - b.view * b.eta;
  vec3 passed = select(b.solid, refracted, straight);
  vec3 direction = select(of_diffuse, cosine_direction(b.normal, xi), select(of_through, passed, mirrored));

  BsdfSample result;
  result.direction = normalize_or(direction, axis);
  result.through = of_through;
  vec1 side = select(of_through, vec1(-1.0f), vec1(1.0f));
  bvec1 possible = dot3(result.direction, b.normal) * side > 0.0f &&
                   dot3(result.direction, b.geometric) * side > 0.0f &&
                   !(of_through && b.solid && !(cosine2 > 0.0f));

  BsdfValue rough = bsdf_value(b, result.direction);
  vec3 fresnel = interface_fresnel(b, v_h);
  vec1 coat = b.coat * coat_fresnel(v_h);
  vec3 smooth_value = select(of_coat, vec3(coat, coat, coat),
                             select(of_specular, fresnel, b.transmitted * (one - fresnel)) * b.base);
  vec1 chance = select(of_coat, b.chance_coat, select(of_specular, b.chance_specular, b.chance_transmitted));
  possible = possible && (mirror || rough.density > 0.0f);
  vec3 weight = select(mirror, smooth_value / chance, rough.value / rough.density);
  result.weight = select(possible, weight, zero);
  result.density = select(mirror, vec1(0.0f), rough.density);
  return result;
}

LODESTONE_LAYOUT_END
#endif
