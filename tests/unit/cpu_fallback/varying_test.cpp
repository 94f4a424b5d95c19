// SPDX-License-Identifier: MIT
// Invocations side by side against one at a time: every operation of the conformance kernel on the same bits,
// at every vector width of this processor. A NaN counts as equal to any NaN.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <random>
#include <span>
#include <vector>

#include "lodestone/cpu_fallback/kernel.h"
#include "lodestone/layout/camera.h"
#include "lodestone/layout/ray_state.h"
#include "lodestone/layout/shading.h"
#include "lodestone/test_support/environment_probe.h"
#include "lodestone/test_support/environments.h"

#include "conformance/operations.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "varying_test.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/environment_kernel-inl.h"
#include "lodestone/cpu_fallback/varying/layout-inl.h"

HWY_BEFORE_NAMESPACE();
#undef LODESTONE_CONFORMANCE_OPERATIONS_H
#undef LODESTONE_LAYOUT_BEGIN
#define LODESTONE_LAYOUT_BEGIN namespace lodestone::cpu_fallback::HWY_NAMESPACE {
#include "conformance/operations.h"
#undef LODESTONE_LAYOUT_BEGIN
#define LODESTONE_LAYOUT_BEGIN namespace lodestone::layout {
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

// As many results as `operands`, whose number is a multiple of every vector's lanes.
HWY_ATTR void apply(uint32_t op, std::span<const glm::uvec4> operands, uint32_t* results) {
  for (size_t i = 0; i < operands.size(); i += lane_count) {
    const uint32_t* from[lane_count];
    for (uint32_t lane = 0; lane < lane_count; ++lane) from[lane] = &operands[i + lane].x;
    hn::StoreU(apply_operation(op, load_quads(from)).v, Unsigneds(), results + i);
  }
}

// sample_2d for the pixels from 0 on: x and y one after the other.
HWY_ATTR void sample(uint32_t seed, uint32_t index, uint32_t pixels, uint32_t* results) {
  for (uint32_t i = 0; i < pixels; i += lane_count) {
    const vec2 xi = sample_2d(seed, uvec1(hn::Iota(Unsigneds(), i)), index, 3u);
    hn::StoreU(floatBitsToUint(xi.x).v, Unsigneds(), results + i);
    hn::StoreU(floatBitsToUint(xi.y).v, Unsigneds(), results + pixels + i);
  }
}

HWY_ATTR void wrap(std::span<const float> coordinates, uint32_t size, uint32_t how, uint32_t* results) {
  for (size_t i = 0; i < coordinates.size(); i += lane_count) {
    const TexelPair pair = texel_pair(hn::LoadU(Floats(), coordinates.data() + i), size, how, 0u);
    hn::StoreU((pair.first ^ pair.second << 16u ^ floatBitsToUint(pair.weight)).v, Unsigneds(), results + i);
  }
}

// For each xi of buffer 3 the direction chosen, its density, the radiance from there and from the other side,
// and the density there: twelve words each in buffer 4.
class WithFrames : public VaryingKernel<EmptyProbe> {
 public:
  using VaryingKernel<EmptyProbe>::VaryingKernel;

 protected:
  Structs<FrameRecord> frames = structs<FrameRecord>(2);
};
class LookAround : public EnvironmentKernel<WithFrames, 0> {
 public:
  using EnvironmentKernel<WithFrames, 0>::EnvironmentKernel;

  HWY_ATTR void operator()() {
    const vec4 xi = as_vec4(load_own(quads(3)));
    const EnvironmentSample sample = sample_environment(vec2(xi.x, xi.y));
    const vec3 ahead = environment_radiance(sample.direction), across = sample.direction * -1.0f,
               behind = environment_radiance(across);
    store_own(quads(4), as_bits(sample.direction, floatBitsToUint(sample.pdf)), 3, 0);
    store_own(quads(4), as_bits(ahead, floatBitsToUint(environment_pdf(across))), 3, 1);
    store_own(quads(4), as_bits(behind, 0u), 3, 2);
  }
};
HWY_ATTR void look_around(const CpuDispatch& dispatch) {
  run_lanes<LookAround>(dispatch, 0, dispatch.invocations);
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {
namespace {

HWY_EXPORT(apply);
HWY_EXPORT(sample);
HWY_EXPORT(wrap);
HWY_EXPORT(look_around);

constexpr size_t count = 1 << 14;

bool is_nan(uint32_t bits) {
  return (bits & 0x7fffffffu) > 0x7f800000u;
}
// Results of these have bits of several numbers in them, and those of a NaN are not compared; or they are not
// defined for a NaN (exp2_).
bool takes_no_nan(uint32_t op) {
  return op == layout::op_cross || op == layout::op_normalize || op == layout::op_cos_sin ||
         op == layout::op_exp2;
}
bool equal(uint32_t a, uint32_t b) {
  return a == b || (is_nan(a) && is_nan(b));
}

// Arbitrary bits; moderate numbers; zeros, denormals, infinities and NaN; small integers.
std::vector<glm::uvec4> operands() {
  constexpr uint32_t special[] = {0x00000000u, 0x80000000u, 0x00000001u, 0x80000001u, 0x007fffffu,
                                  0x00800000u, 0x80800000u, 0x3f800000u, 0xbf800000u, 0x3f000000u,
                                  0xbf000000u, 0x7f7fffffu, 0x7f800000u, 0xff800000u, 0x7fc00000u,
                                  0x4b000000u, 0xcb000001u, 0x7fffffffu};
  std::mt19937 random(7);
  const auto number = [&](uint32_t kind) -> uint32_t {
    if (kind == 0) return random();
    if (kind == 1) return (random() & 0x807fffffu) | (107 + random() % 40) << 23;
    if (kind == 2) return special[random() % std::size(special)];
    return random() % 70000;
  };
  std::vector<glm::uvec4> all(count);
  for (size_t i = 0; i < count; ++i) {
    // A quarter of the vectors has lanes of one kind only, so that fast ways for those are taken as well.
    const auto kind = static_cast<uint32_t>(i / 64 % 4);
    const bool pure = i / 256 % 4 == 0;
    const auto next = [&] { return number(pure ? kind : random() % 4); };
    all[i] = glm::uvec4(next(), next(), next(), next());
  }
  return all;
}

std::vector<glm::uvec4> without_nan(std::vector<glm::uvec4> vectors) {
  for (glm::uvec4& v : vectors) {
    for (int i = 0; i < 4; ++i) v[i] = is_nan(v[i]) ? 0x40490fdbu : v[i];
  }
  return vectors;
}

// Calls check(name of the width) with each width of this processor in turn.
template <class Check>
void at_every_width(const Check& check) {
  int widths = 0;
  for (int64_t rest = hwy::SupportedTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1) {
    hwy::SetSupportedTargetsForTest(rest & -rest);
    check(hwy::TargetName(rest & -rest));
    ++widths;
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GE(widths, 2);
}

TEST(Varying, OperationsHaveTheBitsOfScalarOnes) {
  const std::vector<glm::uvec4> all = operands(), numbers = without_nan(all);
  at_every_width([&](const char* width) {
    for (uint32_t op = 0; op < layout::op_count; ++op) {
      const std::vector<glm::uvec4>& vectors = takes_no_nan(op) ? numbers : all;
      std::vector<uint32_t> results(count);
      HWY_DYNAMIC_DISPATCH(apply)(op, vectors, results.data());
      for (size_t i = 0; i < count; ++i) {
        const uint32_t expected = layout::apply_operation(op, vectors[i]);
        ASSERT_TRUE(equal(results[i], expected))
            << "operation " << op << " at " << width << ": " << std::hex << vectors[i].x << " "
            << vectors[i].y << " " << vectors[i].z << " " << vectors[i].w << " gives " << results[i]
            << ", not " << expected;
      }
    }
  });
}

TEST(Varying, RandomNumbersAreThoseOfScalarCode) {
  constexpr uint32_t pixels = 1024;
  at_every_width([&](const char* width) {
    for (const uint32_t index : {0u, 1u, 5u, 4096u, 0xffffffffu}) {
      std::vector<uint32_t> results(2 * pixels);
      HWY_DYNAMIC_DISPATCH(sample)(11, index, pixels, results.data());
      for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
        const glm::vec2 expected = layout::sample_2d(11, pixel, index, 3);
        ASSERT_EQ(results[pixel], layout::floatBitsToUint(expected.x)) << width << " " << pixel;
        ASSERT_EQ(results[pixels + pixel], layout::floatBitsToUint(expected.y)) << width << " " << pixel;
      }
    }
  });
}

TEST(Varying, TexelsWrapAsInScalarCode) {
  std::mt19937 random(3);
  std::vector<float> coordinates(1024);
  for (float& x : coordinates) x = std::uniform_real_distribution<float>(-5, 5)(random);
  for (size_t i = 0; i < 64; ++i) coordinates[i] = static_cast<float>(i) / 4 - 8;
  at_every_width([&](const char* width) {
    for (const uint32_t size : {1u, 2u, 3u, 1000u, 5000000u}) {
      for (const uint32_t how : {layout::wrap_repeat, layout::wrap_clamp, layout::wrap_mirror}) {
        std::vector<uint32_t> results(coordinates.size());
        HWY_DYNAMIC_DISPATCH(wrap)(coordinates, size, how, results.data());
        for (size_t i = 0; i < coordinates.size(); ++i) {
          const layout::TexelPair pair = layout::texel_pair(coordinates[i], size, how, 0);
          ASSERT_LT(std::max(pair.first, pair.second), size);
          ASSERT_EQ(results[i], pair.first ^ pair.second << 16 ^ layout::floatBitsToUint(pair.weight))
              << width << ": " << coordinates[i] << " of " << size << ", mode " << how;
        }
      }
    }
  });
}

std::vector<glm::uvec4> looked_around(test::EnvironmentProbe& probe, const std::vector<glm::vec2>& pairs) {
  std::vector<glm::uvec4> xi, results(3 * pairs.size());
  for (const glm::vec2& pair : pairs) {
    xi.emplace_back(layout::floatBitsToUint(pair.x), layout::floatBitsToUint(pair.y), 0, 0);
  }
  const auto words = [](auto* items) { return reinterpret_cast<uint32_t*>(items); };
  uint32_t* const buffers[] = {words(probe.environment_quads.data()), probe.environment_cells.data(),
                               words(probe.frames), words(xi.data()), words(results.data())};
  CpuDispatch dispatch;
  dispatch.buffers = buffers;
  dispatch.invocations = static_cast<uint32_t>(pairs.size());
  dispatch.constants[2] = probe.environment_map;
  HWY_DYNAMIC_DISPATCH(look_around)(dispatch);
  return results;
}

TEST(Varying, EnvironmentsAreThoseOfScalarCode) {
  scene::Environment turned = test::sunny_environment(67, 32);
  turned.rotation = 20;
  scene::Scene sky;
  sky.sky = scene::Sky{{1, 2, 3}, {0.5f, 0.5f, 0.5f}, {0, 0.1f, 0}};
  std::mt19937 random(13);
  std::vector<glm::vec2> pairs(1001);
  const auto number = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
  for (glm::vec2& pair : pairs) pair = {number(), number()};
  pairs[0] = {0, 0};
  pairs[1] = {0.99999994f, 0.99999994f};
  for (const scene::Scene& scene : {test::scene_in(turned), sky}) {
    test::EnvironmentProbe probe(scene);
    std::vector<glm::uvec4> expected;
    for (const glm::vec2& pair : pairs) {
      const auto sample = probe.sample_environment(pair);
      const glm::vec3 across = sample.direction * -1.0f;
      expected.push_back(as_bits(sample.direction, layout::floatBitsToUint(sample.pdf)));
      expected.push_back(as_bits(probe.environment_radiance(sample.direction),
                                 layout::floatBitsToUint(probe.environment_pdf(across))));
      expected.push_back(as_bits(probe.environment_radiance(across), 0));
    }
    at_every_width([&](const char* width) { EXPECT_EQ(looked_around(probe, pairs), expected) << width; });
  }
}

// Direction numbers as they are defined, by their recurrence.
TEST(Sampling, TheSecondSobolDimensionFollowsItsRecurrence) {
  std::mt19937 random(5);
  for (int i = 0; i < 10000; ++i) {
    const uint32_t index = i < 100 ? static_cast<uint32_t>(i) : static_cast<uint32_t>(random());
    uint32_t expected = 0, direction = 0x80000000u;
    for (uint32_t rest = index; rest != 0; rest >>= 1) {
      if ((rest & 1) != 0) expected ^= direction;
      direction ^= direction >> 1;
    }
    ASSERT_EQ(layout::bitfieldReverse(layout::sobol_second_reversed(index)), expected) << index;
  }
}

}  // namespace
}  // namespace lodestone::cpu_fallback
#endif
