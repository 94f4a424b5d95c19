// SPDX-License-Identifier: MIT
// Where each ray of a batch goes on from what it hit. One that splits leaves one half waiting in `branches`; one that
// ends gives its place to the last that waits.
#version 460
#extension GL_GOOGLE_include_directive : require
#define INSTANCES_ACCESS restrict
#include "geometry_image/surface.glsl"
#include "layout/path.h"
#include "layout/recursion.h"

QUADS(19, restrict, rays);
QUADS(20, restrict, paths);
QUADS(21, restrict, branches);  // three a ray that waits: its two, and a Branch; two more with its cone
STRUCTS(22, restrict, uint, going_on);  // how many; behind the first vertex a list of the rays that this is about
COUNTERS(23)
PUSH(BranchPush, push);

layout(constant_id = 5) const uint recursion = recursion_specular;

uint branch_place(uint index, uint slot) { return (placing == placing_cones ? 5u : 3u) * (slot * push.stride + index); }

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  if (push.vertex != 0u) {
    index = going_on[index + 1u];
    count_read(1u);
  }
  uvec4 hit;
  uvec4 along;
  LOAD4(hit, hits, index);
  LOAD4(along, rays, 2u * index + 1u);
  vec3 direction = as_vec3(along);
  Branch branch = first_branch();
  if (push.vertex != 0u) {
    uvec4 stored;
    LOAD4(stored, paths, index);
    branch = stored_branch(stored);
  }
  Ray next = no_ray();
  RayCone cone = no_cone();
  scattered = push.vertex != 0u;
  if (!(uintBitsToFloat(along.w) < 0.0) && hit.w != no_index && branch.depth < push.last_vertex) {
    SurfacePoint point = locate_hit(index, hit);
    MaterialRecord material = materials[parts[point.part].material];
    count_read(24u);
    Surface surface = surface_at(material, point, direction);
    if (layered != 0u) branch.throughput = branch.throughput * transmittance(surface, uintBitsToFloat(hit.x));
    Bsdf bsdf = surface_bsdf(surface, layered != 0u);
    branch.depth += 1u;
    if (recursion == recursion_glossy) {
      FrameRecord frame = frames[0];
      uint px;
      uint py;
      ray_pixel(push.first_ray + index, frame.width, frame.height, px, py);
      uint pixel = py * frame.width + px;
      vec2 choice = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_lobe));
      vec2 xi = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_direction));
      BsdfSample drawn = sample_bsdf(without_diffuse(bsdf), choice.x, xi);
      branch.throughput = flush_lost3(branch.throughput * drawn.weight);
      if (!(max_component(branch.throughput) < smallest_throughput))
        next = leaving_ray(surface, drawn.direction, drawn.through ? -1.0 : 1.0, 1e30);
      if (placing == placing_cones) {
        float spread = scattered_spread(drawn.density, frame.tolerance_spread, frame.steepest);
        cone = leaving_cone(point, surface.position, tolerance_of(index), spread);
      }
    } else {
      MirrorRays two = mirror_rays(bsdf, surface);
      vec3 mirrored = flush_lost3(branch.throughput * two.mirrored_weight);
      vec3 passed = flush_lost3(branch.throughput * two.passed_weight);
      bool mirrors = !(max_component(mirrored) < smallest_throughput);
      bool passes = !(max_component(passed) < smallest_throughput);
      Ray through = leaving_ray(surface, two.passed, -1.0, 1e30);
      if (placing == placing_cones)
        cone = leaving_cone(point, surface.position, tolerance_of(index), frames[0].tolerance_spread);
      if (mirrors && passes) {
        uint place = branch_place(index, branch.left);
        Branch waiting = branch;
        waiting.throughput = passed;
        STORE4(branches, place, as_bits(through.origin, floatBitsToUint(through.tmin)));
        STORE4(branches, place + 1u, as_bits(through.direction, floatBitsToUint(through.tmax)));
        STORE4(branches, place + 2u, branch_bits(waiting));
        if (placing == placing_cones) STORE_CONE(branches, place + 3u, cone);
        branch.left += 1u;
      }
      branch.throughput = mirrors ? mirrored : passed;
      if (mirrors) next = leaving_ray(surface, two.mirrored, 1.0, 1e30);
      if (!mirrors && passes) next = through;
    }
  }
  if (next.tmax < 0.0 && branch.left > 0u) {
    uint left = branch.left - 1u;
    uint place = branch_place(index, left);
    uvec4 from;
    uvec4 to;
    uvec4 stored;
    LOAD4(from, branches, place);
    LOAD4(to, branches, place + 1u);
    LOAD4(stored, branches, place + 2u);
    next = stored_ray(from, to);
    if (placing == placing_cones) {
      LOAD4(from, branches, place + 3u);
      LOAD4(to, branches, place + 4u);
      cone = stored_cone(from, to);
    }
    branch = stored_branch(stored);
    branch.left = left;
  }
  if (!(next.tmax < 0.0)) atomicAdd(going_on[0], 1u);
  STORE4(rays, 2u * index, as_bits(next.origin, floatBitsToUint(next.tmin)));
  STORE4(rays, 2u * index + 1u, as_bits(next.direction, floatBitsToUint(next.tmax)));
  STORE4(paths, index, branch_bits(branch));
  if (placing == placing_cones) STORE_CONE(instances, 2u * index, cone);
  flush_counters();
}
