// SPDX-License-Identifier: MIT
#include "lodestone/scene/interpolate.h"

#include <algorithm>
#include <cmath>

namespace lodestone::scene {
namespace {

// The keys on both sides of a moment, and where between them it lies: 0 at the first, 1 at the second.
struct Span {
  size_t first = 0, second = 0;
  float fraction = 0;
  float seconds = 0;  // between the two
};

Span find_span(const std::vector<float>& times, float time) {
  const size_t after = size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (after == 0) return {};
  if (after == times.size()) return {times.size() - 1, times.size() - 1, 0, 0};
  Span span{after - 1, after, 0, times[after] - times[after - 1]};
  // Two ascending times can differ by less than the smallest float, or by more than the largest.
  const double fraction =
      (double(time) - double(times[after - 1])) / (double(times[after]) - double(times[after - 1]));
  span.fraction = float(fraction);
  return span;
}

// Cubic Hermite spline: tangents are a second's worth, so that they are scaled by the length of the span.
void sample_spline(const Channel& channel, const Span& span, size_t width, std::vector<float>& out) {
  const double t = double(span.fraction), seconds = double(span.seconds);
  const double t2 = t * t, t3 = t2 * t;
  const float* first = &channel.values[span.first * 3 * width];
  const float* second = &channel.values[span.second * 3 * width];
  for (size_t c = 0; c < width; ++c) {
    const double value0 = double(first[width + c]), out_tangent = double(first[2 * width + c]);
    const double in_tangent = double(second[c]), value1 = double(second[width + c]);
    out[c] = float((2 * t3 - 3 * t2 + 1) * value0 + seconds * (t3 - 2 * t2 + t) * out_tangent +
                   (-2 * t3 + 3 * t2) * value1 + seconds * (t3 - t2) * in_tangent);
  }
}

glm::quat quaternion(const float* xyzw) {
  return normalized_or_identity({xyzw[3], xyzw[0], xyzw[1], xyzw[2]});
}

void store(const glm::quat& q, std::vector<float>& out) {
  out = {q.x, q.y, q.z, q.w};
}

}  // namespace

glm::quat normalized_or_identity(const glm::quat& q) {
  const glm::dquat wide(q);
  const double length = std::sqrt(glm::dot(wide, wide));
  return length > 0 && std::isfinite(length) ? glm::quat(wide / length) : glm::quat(1, 0, 0, 0);
}

glm::quat slerp_shortest(const glm::quat& from, const glm::quat& to, float t) {
  if (t == 0) return from;  // at a key: what follows rounds
  const float dot = glm::dot(from, to);
  const glm::quat near = dot < 0 ? -to : to;
  const float cosine = std::min(std::abs(dot), 1.0f);
  // Close together the sines below lose their digits, and the chord is as good as the arc.
  constexpr float almost_equal = 0.9995f;
  if (cosine > almost_equal) return normalized_or_identity(from * (1 - t) + near * t);
  const float angle = std::acos(cosine);
  return normalized_or_identity((from * std::sin((1 - t) * angle) + near * std::sin(t * angle)) /
                                std::sin(angle));
}

std::vector<float> sample_channel(const Channel& channel, float time, size_t width) {
  const Span span = find_span(channel.times, time);
  std::vector<float> out(width);
  const bool is_rotation = channel.path == Channel::Path::rotation;
  if (channel.interpolation == Channel::Interpolation::cubic_spline) {
    sample_spline(channel, span, width, out);
    if (is_rotation) store(quaternion(out.data()), out);
    return out;
  }
  const float* first = &channel.values[span.first * width];
  const float* second = &channel.values[span.second * width];
  const float t = channel.interpolation == Channel::Interpolation::step ? 0 : span.fraction;
  if (is_rotation) {
    store(slerp_shortest(quaternion(first), quaternion(second), t), out);
    return out;
  }
  for (size_t c = 0; c < width; ++c) out[c] = first[c] * (1 - t) + second[c] * t;
  return out;
}

}  // namespace lodestone::scene
