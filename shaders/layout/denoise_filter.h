// SPDX-License-Identifier: MIT
// The edge-avoiding a-trous wavelet filter (Dammertz, Sewtz, Hanika and Lensch 2010), whose weight for light
// follows the variance of the pixel's own samples and lowers it from level to level (Schied et al. 2017,
// "Spatiotemporal variance-guided filtering", without the part that looks at other frames). Included by
// kernels behind the buffers it names, and by the CPU fallback inside a class whose members have those names:
//
//   guides  three quads a pixel, the means over its samples: { demodulator R G B, 1 where the pixel may be
//   filtered, else
//           0 }, { normal X Y Z, share of the samples that hit something }, { position from the camera X Y Z,
//           0 }
//   grid    the DenoisePush
//   light   a quad a pixel: { radiance over the demodulator R G B, variance of its luminance }
//
// Two pixels are of one surface as far as their guides say so. Their distance from each other's tangent plane
// counts in relation to their distance, so no length has to be chosen and slanted planes are planes.

struct Guide {
  vec3 demodulator;
  vec1 valid;
  vec3 normal;  // shorter than 1 where the samples' differ
  vec1 coverage;
  vec3 position;
};

struct FilteredLight {
  vec3 color;
  vec1 variance;
};

FN Guide guide_of(uvec1 pixel) {
  uvec4 g0;
  uvec4 g1;
  uvec4 g2;
  LOAD4(g0, guides, 3u * pixel);
  LOAD4(g1, guides, 3u * pixel + 1u);
  LOAD4(g2, guides, 3u * pixel + 2u);
  Guide guide;
  guide.demodulator = as_vec3(g0);
  guide.valid = uintBitsToFloat(g0.w);
  guide.normal = as_vec3(g1);
  guide.coverage = uintBitsToFloat(g1.w);
  guide.position = as_vec3(g2);
  return guide;
}

FN FilteredLight light_of(uvec1 pixel) {
  uvec4 bits;
  LOAD4(bits, light, pixel);
  FilteredLight result;
  result.color = as_vec3(bits);
  result.variance = uintBitsToFloat(bits.w);
  return result;
}

// How different two pixels' surfaces are: their weight is 2 to the power of minus that.
FN vec1 surface_difference(IN(Guide) p, IN(Guide) q) {
  vec3 turn = p.normal - q.normal;
  vec3 tint = p.demodulator - q.demodulator;
  vec1 covered = p.coverage - q.coverage;
  vec3 away = flush_tiny3(q.position - p.position);
  vec1 distance = sqrt(dot3(away, away));
  vec1 height = flush_lost(dot3(p.normal, away)) / select(distance > 0.0f, distance, vec1(1.0f));
  return 64.0f * dot3(turn, turn) + 64.0f * height * height + 8.0f * dot3(tint, tint) +
         32.0f * covered * covered;
}

// Binomial weights 1 4 6 4 1 over 16: a cubic B-spline.
FN float spline_weight(int offset) {
  float square = float(offset * offset);
  return 0.375f - square * 0.140625f + square * square * 0.015625f;
}

// Tap 0 to 24 of the pixel (px, py). `weight` is 0 where the tap lies outside the picture, and there `pixel`
// is the pixel itself.
struct Tap {
  uvec1 pixel;
  vec1 weight;
};

FN Tap tap_of(uint tap, uvec1 px, uvec1 py) {
  int dx = int(tap % 5u) - 2;
  int dy = int(tap / 5u) - 2;
  // Left of and above the picture they are greater than any size.
  uvec1 x = uvec1(ivec1(px) + dx * int(grid.step));
  uvec1 y = uvec1(ivec1(py) + dy * int(grid.step));
  bvec1 inside_x = x < grid.width;
  bvec1 inside_y = y < grid.height;
  bvec1 inside = inside_x && inside_y;
  uvec1 own = py * grid.width + px;
  uvec1 other = y * grid.width + x;
  vec1 weight = spline_weight(dx) * spline_weight(dy);
  Tap result;
  result.pixel = select(inside, other, own);
  result.weight = select(inside, weight, 0.0f);
  return result;
}

// 2^-difference, 0 from where it no longer counts, also for what is no number.
FN vec1 falloff(vec1 difference) {
  vec1 power = exp2_(difference * -1.0f);
  return select(difference < 30.0f, power, vec1(0.0f));
}

// The variance of a pixel as its neighbours on the same surface have it too: that of a few samples is a
// guess.
FN vec1 shared_variance(uvec1 px, uvec1 py) {
  Guide own = guide_of(py * grid.width + px);
  vec1 sum = 0.0f;
  vec1 weights = 0.0f;
  for (uint k = 0u; k < 25u; ++k) {
    Tap tap = tap_of(k, px, py);
    Guide guide = guide_of(tap.pixel);
    FilteredLight other = light_of(tap.pixel);
    vec1 weight = tap.weight * guide.valid * falloff(surface_difference(own, guide));
    sum = sum + flush_lost(weight * other.variance);
    weights = weights + weight;
  }
  vec1 divisor = select(weights > 0.0f, weights, vec1(1.0f));
  return flush_tiny(sum / divisor);
}

// One level. Light that is two standard deviations of the pixel's own away weighs half as much, four a
// sixteenth.
FN FilteredLight filtered_light(uvec1 px, uvec1 py) {
  uvec1 pixel = py * grid.width + px;
  Guide own = guide_of(pixel);
  FilteredLight here = light_of(pixel);
  vec1 own_luminance = luminance(here.color);
  vec1 scale = 2.0f * sqrt(here.variance) + 1e-12f;
  vec3 sum = vec3(0.0f, 0.0f, 0.0f);
  vec1 variance = 0.0f;
  vec1 weights = 0.0f;
  for (uint k = 0u; k < 25u; ++k) {
    Tap tap = tap_of(k, px, py);
    Guide guide = guide_of(tap.pixel);
    FilteredLight other = light_of(tap.pixel);
    vec1 apart = abs1(luminance(other.color) - own_luminance) / scale;
    vec1 weight = tap.weight * guide.valid * falloff(surface_difference(own, guide) + apart * apart);
    sum = sum + other.color * weight;
    variance = variance + flush_lost(weight * weight * other.variance);
    weights = weights + weight;
  }
  vec1 divisor = select(weights > 0.0f, weights, vec1(1.0f));
  FilteredLight result;
  result.color = flush_tiny3(sum / divisor);
  result.variance = flush_tiny(variance / (divisor * divisor));
  return result;
}
