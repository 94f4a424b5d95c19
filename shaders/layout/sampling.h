// SPDX-License-Identifier: MIT
// Random numbers for all tracers: Sobol points, Owen-scrambled by hashing (Laine and Karras 2011, "Stratified
// sampling for stochastic transparency"; Burley 2020, "Practical hash-based Owen scrambling"). A number is a
// function of (seed, pixel, sample, dimension) alone, so pictures do not depend on threads, batches or the
// device.
#ifndef LODESTONE_LAYOUT_SAMPLING_H
#define LODESTONE_LAYOUT_SAMPLING_H

#include "layout/arithmetic.h"

LODESTONE_LAYOUT_BEGIN

FN uint hash(uint x) {
  x = x ^ (x >> 16u);
  x = x * 0x21f0aaadu;
  x = x ^ (x >> 15u);
  x = x * 0xd35a2d97u;
  x = x ^ (x >> 15u);
  return x;
}
FN uint hash_combine(uint seed, uint x) {
  return hash(seed ^ (x * 0x9e3779b9u + 0x85ebca6bu));
}

// Owen scrambling of reversed bits: each bit flips by a hash of the bits above it.
FN uint owen_scramble(uint x, uint seed) {
  x = bitfieldReverse(x);
  x = x + seed;
  x = x ^ (x * 0x6c50b47cu);
  x = x ^ (x * 0xb82f1e52u);
  x = x ^ (x * 0xc7afe638u);
  x = x ^ (x * 0x8d22f6e6u);
  return bitfieldReverse(x);
}

// The second Sobol dimension (the first is the reversed index): primitive polynomial x + 1.
FN uint sobol_second(uint index) {
  uint direction = 0x80000000u;
  uint result = 0u;
  for (int bit = 0; bit < 32; ++bit) {
    if ((index & 1u) != 0u) result = result ^ direction;
    index = index >> 1u;
    direction = direction ^ (direction >> 1u);
  }
  return result;
}

FN float unit_float(uint x) {
  return float(x >> 8u) * 5.9604645e-8f;
}  // [0, 1), 24 bits

// Sample `index` of the two-dimensional sequence number `pair` of a pixel.
FN vec2 sample_2d(uint seed, uint pixel, uint index, uint pair) {
  uint key = hash_combine(hash_combine(seed, pixel), pair);
  uint shuffled = owen_scramble(index, hash_combine(key, 0u));
  uint x = owen_scramble(bitfieldReverse(shuffled), hash_combine(key, 1u));
  uint y = owen_scramble(sobol_second(shuffled), hash_combine(key, 2u));
  return vec2(unit_float(x), unit_float(y));
}

CONST uint pair_pixel = 0u;  // position in the pixel
CONST uint pair_sky = 1u;    // direction to the sky

LODESTONE_LAYOUT_END
#endif
