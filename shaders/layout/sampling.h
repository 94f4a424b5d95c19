// SPDX-License-Identifier: MIT
// Random numbers for all tracers: Sobol points, Owen-scrambled by hashing (Laine and Karras 2011, "Stratified
// sampling for stochastic transparency"; Burley 2020, "Practical hash-based Owen scrambling"). A number is a
// function of (seed, pixel, sample, dimension) alone, so pictures do not depend on threads, batches or the
// device.
#ifndef LODESTONE_LAYOUT_SAMPLING_H
#define LODESTONE_LAYOUT_SAMPLING_H

#include "layout/arithmetic.h"

LODESTONE_LAYOUT_BEGIN

FN uvec1 hash(uvec1 x) {
  x = x ^ (x >> 16u);
  x = x * 0x21f0aaadu;
  x = x ^ (x >> 15u);
  x = x * 0xd35a2d97u;
  x = x ^ (x >> 15u);
  return x;
}
FN uvec1 hash_combine(uvec1 seed, uvec1 x) {
  return hash(seed ^ (x * 0x9e3779b9u + 0x85ebca6bu));
}

// Owen scrambling of a fraction with reversed bits: each bit flips by a hash of the bits below it.
FN uvec1 scramble_reversed(uvec1 x, uvec1 seed) {
  x = x + seed;
  x = x ^ (x * 0x6c50b47cu);
  x = x ^ (x * 0xb82f1e52u);
  x = x ^ (x * 0xc7afe638u);
  x = x ^ (x * 0x8d22f6e6u);
  return x;
}

// The second Sobol dimension with its bits reversed (the first, reversed, is the index itself). Its primitive
// polynomial is x + 1, so that its direction numbers are the powers of x + 1 over GF(2), and bit i of the
// index stands for (x + 1)^i: the index as a polynomial in x + 1, expanded by halves.
FN uvec1 sobol_second_reversed(uvec1 index) {
  index = index ^ (index >> 16u);
  index = index ^ ((index >> 8u) & 0x00ff00ffu);
  index = index ^ ((index >> 4u) & 0x0f0f0f0fu);
  index = index ^ ((index >> 2u) & 0x33333333u);
  return index ^ ((index >> 1u) & 0x55555555u);
}

// [0, 1), 24 bits.
FN vec1 unit_float(uvec1 x) {
  return vec1(x >> 8u) * 5.9604645e-8f;
}

// Sample `index` of the two-dimensional sequence number `pair` of a pixel.
FN vec2 sample_2d(uint seed, uvec1 pixel, uint index, uint pair) {
  uvec1 key = hash_combine(hash_combine(seed, pixel), pair);
  uvec1 shuffled = bitfieldReverse(scramble_reversed(bitfieldReverse(index), hash_combine(key, 0u)));
  uvec1 x = bitfieldReverse(scramble_reversed(shuffled, hash_combine(key, 1u)));
  uvec1 y = bitfieldReverse(scramble_reversed(sobol_second_reversed(shuffled), hash_combine(key, 2u)));
  return vec2(unit_float(x), unit_float(y));
}

// What the sequences of a pixel are for.
CONST uint pair_pixel = 0u;         // position in the pixel
CONST uint pair_sky = 1u;           // direction to the sky; one a light
CONST uint pair_lens = 0x8000u;     // position on the lens
CONST uint pair_ambient = 0x8001u;  // direction of ambient occlusion
CONST uint pair_time = 0x8002u;     // x: while the shutter is open
CONST uint pair_vertex = 0x10000u;  // vertex k of a path has the pairs from pair_vertex + 4 k on:
CONST uint of_lobe = 0u;            // x: lobe, y: Russian roulette
CONST uint of_direction = 1u;
CONST uint of_light = 2u;  // x: which light
CONST uint of_light_direction = 3u;
CONST uint pair_emitter = 0x40000000u;  // x: instance, y: triangle; one a vertex

FN uint sky_pair(uint vertex, uint light) {
  return pair_sky + light + (vertex << 20u);
}
FN uint vertex_pair(uint vertex, uint use) {
  return pair_vertex + 4u * vertex + use;
}
FN uint emitter_pair(uint vertex) {
  return pair_emitter + vertex;
}

LODESTONE_LAYOUT_END
#endif
