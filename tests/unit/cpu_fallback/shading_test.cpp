// SPDX-License-Identifier: MIT
// What surfaces reflect: the same bits for invocations side by side as one at a time, and no more than there
// is.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lodestone/layout/camera.h"
#include "lodestone/layout/ray_state.h"

#include "shading_cases.h"
#include "white_surface.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading_test.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/layout-inl.h"

HWY_BEFORE_NAMESPACE();
#undef LODESTONE_SHADING_CASES_H
#undef LODESTONE_LAYOUT_BEGIN
#define LODESTONE_LAYOUT_BEGIN namespace lodestone::cpu_fallback::HWY_NAMESPACE {
#include "shading_cases.h"
#undef LODESTONE_LAYOUT_BEGIN
#define LODESTONE_LAYOUT_BEGIN namespace lodestone::layout {
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

// Red, green and blue of the light sent and of the surface's own, `count` words each; a multiple of every
// vector's lanes.
HWY_ATTR void shade_cases(const LightRecord& light, uint32_t count, uint32_t* results) {
  for (uint32_t i = 0; i < count; i += lane_count) {
    const uvec1 index = hn::Iota(Unsigneds(), i);
    const Surface s = shading_case(index);
    const vec3 sent = sample_light(light, s, nothing_traced()).radiance;
    const vec3 emitted = emitted_radiance(s);
    uint32_t* to = results + i;
    for (const vec1 value : {sent.x, sent.y, sent.z, emitted.x, emitted.y, emitted.z}) {
      hn::StoreU(floatBitsToUint(value).v, Unsigneds(), to);
      to += count;
    }
  }
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {
namespace {

HWY_EXPORT(shade_cases);

TEST(Shading, IsThatOfScalarCodeAtEveryWidth) {
  constexpr uint32_t count = 1 << 12;
  layout::LightRecord light{};
  light.position = {0.5f, 2, 1};
  light.direction = {0, -1, 0};
  light.color = {3, 2, 1};
  light.cone_scale = 2;
  light.cone_offset = -0.5f;
  for (const uint32_t kind : {layout::light_directional, layout::light_point, layout::light_spot}) {
    light.kind = kind;
    int widths = 0;
    for (int64_t rest = hwy::SupportedTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1) {
      hwy::SetSupportedTargetsForTest(rest & -rest);
      std::vector<uint32_t> results(6 * count);
      HWY_DYNAMIC_DISPATCH(shade_cases)(light, count, results.data());
      for (uint32_t i = 0; i < count; ++i) {
        const layout::Surface s = layout::shading_case(i);
        const glm::vec3 sent = layout::sample_light(light, s, layout::nothing_traced()).radiance;
        const glm::vec3 emitted = layout::emitted_radiance(s);
        for (uint32_t c = 0; c < 3; ++c) {
          const auto channel = static_cast<glm::length_t>(c);
          ASSERT_EQ(results[c * count + i], layout::floatBitsToUint(sent[channel]))
              << "light " << kind << ", case " << i << " at " << hwy::TargetName(rest & -rest);
          ASSERT_EQ(results[(c + 3) * count + i], layout::floatBitsToUint(emitted[channel])) << i;
        }
      }
      ++widths;
    }
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_GE(widths, 2);
  }
}

// The share of white light from everywhere that is sent to the viewer.
double reflectance(const layout::Surface& s) {
  constexpr int rings = 256, spokes = 256;
  double sum = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const double z = (ring + 0.5) / rings, radius = std::sqrt(1 - z * z);
    for (int spoke = 0; spoke < spokes; ++spoke) {
      const double turn = 2 * M_PI * (spoke + 0.5) / spokes;
      const glm::vec3 to_light(radius * std::cos(turn), radius * std::sin(turn), z);
      sum += double(layout::reflected(s, to_light, layout::nothing_traced()).y);
    }
  }
  return sum * 2 * M_PI / (rings * spokes);
}

TEST(Shading, ACoatNeverAddsEnergy) {
  for (const float angle : {0.0f, 0.7f, 1.2f, 1.5f}) {
    for (const float metallic : {0.0f, 1.0f}) {
      layout::Surface s = white_surface(angle);
      s.metallic = metallic;
      const double base = reflectance(s);
      for (const float roughness : {0.3f, 0.6f, 1.0f}) {
        s.clearcoat_roughness = roughness;
        for (const float clearcoat : {0.5f, 1.0f}) {
          s.clearcoat = clearcoat;
          EXPECT_LT(reflectance(s), std::max(base, 1.0) + 1e-3)
              << angle << " " << metallic << " " << roughness;
        }
      }
    }
  }
}

TEST(Shading, ACoatShinesOverBlackAndDimsWhatIsBelow) {
  layout::Surface s = white_surface(0.3f);
  const glm::vec3 mirrored(-s.view.x, 0, s.view.z);
  s.albedo = {0, 0, 0};
  s.f0 = {0, 0, 0};
  s.f90 = 0;
  s.emission = {1, 2, 4};
  EXPECT_EQ(layout::reflected(s, mirrored, layout::nothing_traced()).x, 0);
  EXPECT_EQ(layout::emitted_radiance(s), s.emission);
  s.clearcoat = 1;
  s.clearcoat_roughness = 0.3f;
  EXPECT_GT(layout::reflected(s, mirrored, layout::nothing_traced()).x, 0.04f);
  EXPECT_NEAR(layout::emitted_radiance(s).y, 2 * 0.96f, 1e-3f);
  s.clearcoat_normal = {1, 0, 0};  // away from the light
  EXPECT_EQ(layout::reflected(s, mirrored, layout::nothing_traced()).x, 0);
}

TEST(Shading, WhatPassesThroughIsNotScatteredBack) {
  layout::Surface s = white_surface(0.3f);
  const double opaque = reflectance(s);
  s.albedo = {0, 0, 0};
  const double mirrored = reflectance(s);
  s.albedo = {1, 1, 1};
  s.transmission = 1;
  EXPECT_NEAR(reflectance(s), mirrored, 1e-6);
  s.transmission = 0.5f;
  EXPECT_NEAR(reflectance(s), (opaque + mirrored) / 2, 1e-6);
}

TEST(Shading, AMetalReflectsWhateverItsDielectricPartWould) {
  layout::Surface s = white_surface(1.2f);
  s.metallic = 1;
  const double plain = reflectance(s);
  s.f0 = {0, 0, 0};
  s.f90 = 0;
  EXPECT_EQ(reflectance(s), plain);
  s.metallic = 0;
  s.albedo = {0, 0, 0};
  EXPECT_EQ(reflectance(s), 0);
}

}  // namespace
}  // namespace lodestone::cpu_fallback
#endif
