// SPDX-License-Identifier: MIT
// What the denoising passes are told, and how the light of a pixel is taken apart for them.
#ifndef LODESTONE_LAYOUT_DENOISE_H
#define LODESTONE_LAYOUT_DENOISE_H

#include "layout/arithmetic.h"

LODESTONE_LAYOUT_BEGIN

// One sample of a batch, and what its rays from the camera have hit.
struct FeaturesPush {
  uint rays;
  uint first;   // 1: the pass starts a sum, 0: it adds to one
  uint tinted;  // 1: surfaces dim light by their albedo; 0: the integrator shows no colours
};

struct MomentsPush {
  uint rays;
  uint first;  // 1: of the pixel's samples
};

// Of the whole picture.
struct DenoisePush {
  uint width;
  uint height;
  uint step;  // pixels from one tap of the filter to the next
};

// Taps that are 1, 2, 4, 8 and 16 pixels apart: what the last one reads is up to 62 pixels away.
CONST uint denoise_levels = 5u;

// What light is divided by before it is filtered, so that no texture is blurred: the albedo and the four
// percent that every dielectric mirrors, which keep black surfaces above 0.
FN vec3 demodulator(vec3 albedo) {
  return albedo + vec3(0.04f, 0.04f, 0.04f);
}

// The means of a pixel's samples.
struct PixelFeatures {
  vec3 tint;  // demodulator
  vec1 coverage;
  vec3 normal;
  vec3 position;
};

// From the sums of `count` samples, as shaders/geometry_image/features.comp has them.
FN PixelFeatures pixel_features(vec4 tint, vec3 normal, vec3 position, float count) {
  vec1 hits = max2(tint.w, 1.0f);
  PixelFeatures mean;
  mean.tint = vec3(tint.x, tint.y, tint.z) / count;
  mean.coverage = tint.w / count;
  mean.normal = flush_tiny3(normal / hits);
  mean.position = flush_tiny3(position / hits);
  return mean;
}

struct PixelLight {
  vec3 color;     // over the demodulator
  vec1 variance;  // of its luminance
  vec1 valid;     // 0: something is no finite number, and all is 0
};

// How far a mean of `count` samples (at least 2) is off, by the sums of them and of their squares.
FN vec1 deviation_of_mean(vec1 sum, vec1 squares, float count) {
  vec1 mean = sum / count;
  vec1 variance = max2(squares / count - flush_lost(mean * mean), 0.0f);
  return sqrt(flush_lost(variance / (count - 1.0f)));
}

// The channels' errors go together, for they are of the same paths: so their deviations add up.
FN PixelLight pixel_light(vec3 sum, vec3 squares, vec3 tint, float count) {
  vec3 deviation =
      vec3(deviation_of_mean(sum.x, squares.x, count), deviation_of_mean(sum.y, squares.y, count),
           deviation_of_mean(sum.z, squares.z, count));
  vec1 spread = luminance(deviation / tint);
  vec3 color = flush_tiny3(sum / count / tint);
  vec1 variance = flush_tiny(spread * spread);
  bvec1 valid = abs1(color.x) + abs1(color.y) + abs1(color.z) + variance <= infinity_bits_as_max;
  PixelLight mean;
  mean.color = select(valid, color, vec3(0.0f, 0.0f, 0.0f));
  mean.variance = select(valid, variance, vec1(0.0f));
  mean.valid = select(valid, vec1(1.0f), vec1(0.0f));
  return mean;
}

LODESTONE_LAYOUT_END
#endif
