// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "lodestone/layout/shading.h"

namespace lodestone::cpu_fallback {

// White, seen at `angle` from its normal.
inline layout::Surface white_surface(float angle) {
  layout::Surface s{};
  s.geometric = s.normal = {0, 0, 1};
  s.view = {std::sin(angle), 0, std::cos(angle)};
  s.albedo = {1, 1, 1};
  s.roughness = 0.5f;
  s.occlusion = 1;
  layout::make_plain(s);
  return s;
}

}  // namespace lodestone::cpu_fallback
