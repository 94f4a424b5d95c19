// SPDX-License-Identifier: MIT
#include "lodestone/render/light_choice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lodestone/layout/arithmetic.h"
#include "lodestone/render/number_shares.h"

namespace lodestone::render {
namespace {

constexpr double pi = std::numbers::pi;

double power_of(const layout::LightRecord& light, const LightPowers& powers) {
  const double color = std::max(double(layout::luminance(light.color)), 0.0);
  const double seen = pi * powers.radius * powers.radius;
  switch (light.kind) {
    case layout::light_directional:
      return color * seen;
    case layout::light_point:
      return color * 4 * pi;
    case layout::light_spot: {
      // Half of the cosines between the inner and the outer cone count (LightRecord::cone_scale).
      const double outer = -double(light.cone_offset) / std::max(double(light.cone_scale), 1e-6);
      const double inner = outer + 1 / std::max(double(light.cone_scale), 1e-6);
      return color * 2 * pi * std::clamp(1 - (inner + outer) / 2, 0.0, 2.0);
    }
    case layout::light_sky:
      return powers.sky * seen;
    default:
      return powers.emitters * 2 * pi;  // of both sides
  }
}

}  // namespace

LightChoice choose_lights(std::vector<layout::LightRecord>& lights, const LightPowers& powers) {
  std::vector<double> weights;
  double total = 0, shining = 0;
  for (const layout::LightRecord& light : lights) {
    const double power = power_of(light, powers);
    weights.push_back(std::isfinite(power) ? power : 0);
    total += weights.back();
    shining += weights.back() > 0 ? 1 : 0;
  }
  if (!std::isfinite(total)) std::fill(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights)
    if (weight > 0) weight = 0.5 * weight / total + 0.5 / shining;
  std::vector<uint32_t> first(lights.size() + 1);
  share_out(weights, first);
  LightChoice choice;
  choice.step = greatest_step(static_cast<uint32_t>(lights.size()));
  for (size_t i = 0; i < lights.size(); ++i) {
    lights[i].first_number = first[i];
    lights[i].numbers = first[i + 1] - first[i];
    const float chance = static_cast<float>(lights[i].numbers) / static_cast<float>(drawn_numbers);
    if (lights[i].kind == layout::light_sky) choice.sky_chance = chance;
    if (lights[i].kind == layout::light_emitters) {
      choice.emitter_chance = chance;
      choice.first_emitter_number = first[i];
    }
  }
  return choice;
}

}  // namespace lodestone::render
