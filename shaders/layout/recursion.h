// SPDX-License-Identifier: MIT
// Rays that go on from surface to surface with direct light at each, as Whitted's: the integrators
// `specular`, which follows both the mirrored and the refracted ray of smooth surfaces, and `glossy`, which
// follows one drawn from the rough lobes.
#ifndef LODESTONE_LAYOUT_RECURSION_H
#define LODESTONE_LAYOUT_RECURSION_H

#include "layout/bsdf.h"

LODESTONE_LAYOUT_BEGIN

// What a kernel is compiled for.
CONST uint recursion_none = 0u;
CONST uint recursion_specular = 1u;
CONST uint recursion_glossy = 2u;

// A ray that carries less is not followed.
CONST float smallest_throughput = 9.765625e-4f;  // 2^-10

// Where the rays of a batch go on. Behind the first vertex only those of a list (layout/ray_list.h) do.
struct BranchPush {
  uint first_ray;
  uint rays;
  uint sample_index;
  uint vertex;       // 0: where the camera's ray ends
  uint last_vertex;  // from which nothing goes on
  uint stride;       // rays of the batch: those that wait lie one such row after the other
};

// Stored between rays, a quad a pixel.
struct Branch {
  vec3 throughput;
  uvec1 depth;  // surfaces that it came by
  uvec1 left;   // rays of the pixel that wait their turn
};

FN Branch stored_branch(uvec4 bits) {
  Branch branch;
  branch.throughput = vec3(uintBitsToFloat(bits.x), uintBitsToFloat(bits.y), uintBitsToFloat(bits.z));
  branch.depth = bits.w & 0xffffu;
  branch.left = bits.w >> 16u;
  return branch;
}
FN uvec4 branch_bits(IN(Branch) branch) {
  return uvec4(floatBitsToUint(branch.throughput.x), floatBitsToUint(branch.throughput.y),
               floatBitsToUint(branch.throughput.z), branch.depth | branch.left << 16u);
}
FN Branch first_branch() {
  Branch branch;
  branch.throughput = vec3(1.0f, 1.0f, 1.0f);
  branch.depth = 0u;
  branch.left = 0u;
  return branch;
}

// How far a surface is a mirror for `specular`: wholly up to a roughness of 0.2, not from 0.4 on.
FN vec1 mirror_share(vec1 roughness) {
  return saturate((0.4f - roughness) * 5.0f);
}

// What direct light leaves out because rays go on and find it, where they do.
FN Traced traced_lobes(uint recursion, IN(Surface) s, bvec1 goes_on) {
  Traced traced = nothing_traced();
  if (recursion == recursion_glossy) {
    traced.base_sky = select(goes_on, vec1(1.0f), vec1(0.0f));
    traced.coat_sky = traced.base_sky;
  }
  if (recursion == recursion_specular) {
    traced.base_sky = select(goes_on, mirror_share(s.roughness), vec1(0.0f));
    traced.coat_sky = select(goes_on, mirror_share(s.clearcoat_roughness), vec1(0.0f));
    traced.base_lights = traced.base_sky;
    traced.coat_lights = traced.coat_sky;
  }
  return traced;
}

// The mirrored ray and the one through the surface, and what each carries; 0: there is none.
struct MirrorRays {
  vec3 mirrored;
  vec3 mirrored_weight;
  vec3 passed;
  vec3 passed_weight;
};

FN MirrorRays mirror_rays(IN(Bsdf) b, IN(Surface) s) {
  vec3 zero = vec3(0.0f, 0.0f, 0.0f);
  vec1 n_v = saturate(dot3(b.normal, b.view));
  vec3 fresnel = interface_fresnel(b, n_v);
  vec1 coat = b.coat * coat_fresnel(n_v) * mirror_share(s.clearcoat_roughness);
  MirrorRays rays;
  rays.mirrored = normalize_or(b.normal * (2.0f * n_v) - b.view, b.normal);
  rays.mirrored_weight = fresnel * (b.base * mirror_share(s.roughness)) + vec3(coat, coat, coat);
  rays.mirrored_weight = select(dot3(rays.mirrored, b.geometric) > 0.0f, rays.mirrored_weight, zero);
  vec1 cosine2 = 1.0f - b.eta * b.eta * (1.0f - n_v * n_v);
  vec3 refracted = b.normal * (b.eta * n_v - sqrt(max2(cosine2, 0.0f))) - b.view * b.eta;
  rays.passed = normalize_or(select(b.solid, refracted, b.view * -1.0f), b.normal * -1.0f);
  rays.passed_weight = b.transmitted * (vec3(1.0f, 1.0f, 1.0f) - fresnel) * b.base;
  bvec1 possible = dot3(rays.passed, b.geometric) < 0.0f && (!b.solid || cosine2 > 0.0f);
  rays.passed_weight = select(possible, rays.passed_weight, zero);
  return rays;
}

// Without the lobe whose light `shade` adds.
FN Bsdf without_diffuse(Bsdf b) {
  b.diffuse = vec3(0.0f, 0.0f, 0.0f);
  return with_chances(b);
}

LODESTONE_LAYOUT_END
#endif
