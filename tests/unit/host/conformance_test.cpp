// SPDX-License-Identifier: MIT
// One arithmetic: the conformance kernel on a device against the same source compiled as C++, a million
// vectors of operands for each operation, bit by bit. A NaN counts as equal to any NaN: which payload
// survives is nobody's promise.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <iterator>
#include <random>
#include <vector>

#include "conformance/operations.h"
#include "device_fixture.h"

namespace lodestone::host {
namespace {

using layout::uvec4;

constexpr uint32_t vector_count = 1u << 20;

constexpr std::array<const char*, layout::op_count> operation_names = {
    "x + y",         "x - y",       "x * y",      "x / y",   "sqrt",        "floor",      "-x",
    "x < y",         "x <= y",      "x == y",     "x != y",  "min2",        "max2",       "x * y + z",
    "dot3",          "cross3",      "uint(x)",    "int(x)",  "float(uint)", "float(int)", "round trip",
    "uint division", "int shift",   "bit counts", "x * 0.5", "1 / x",       "normalize",  "exp2",
    "log2",          "cos and sin", "atan2"};

bool is_nan(uint32_t bits) {
  return (bits & 0x7fffffffu) > 0x7f800000u;
}
bool is_tiny(uint32_t bits) {
  return layout::flush_bits(bits) != bits;
}

bool is_integer(uint32_t op) {
  return op == layout::op_from_uint || op == layout::op_from_int ||
         (op >= layout::op_divide_uint && op <= layout::op_bits);
}

// More than one rounding: steps in between are not seen by a flush at the end.
bool is_compound(uint32_t op) {
  return (op >= layout::op_multiply_add && op <= layout::op_cross) || op >= layout::op_normalize;
}

uint32_t host_result(uint32_t op, uvec4 u, bool flush) {
  if (flush)
    u = uvec4(layout::flush_bits(u.x), layout::flush_bits(u.y), layout::flush_bits(u.z),
              layout::flush_bits(u.w));
  const uint32_t result = layout::apply_operation(op, u);
  return flush ? layout::flush_bits(result) : result;
}

// Numbers between 2^-20 and 2^20 of either sign: nothing that three operations make of them is denormal or
// infinite.
std::vector<uvec4> moderate_vectors() {
  std::mt19937 random(1);
  const auto number = [&] { return (random() & 0x807fffffu) | (127 - 20 + random() % 40) << 23; };
  std::vector<uvec4> vectors(vector_count);
  for (uvec4& v : vectors) v = uvec4(number(), number(), number(), number());
  return vectors;
}

// All there is: zeros, denormals, infinities and NaN of every kind among arbitrary bits.
std::vector<uvec4> extreme_vectors() {
  constexpr uint32_t special[] = {
      0x00000000u, 0x80000000u, 0x00000001u, 0x80000001u, 0x007fffffu, 0x807fffffu, 0x00800000u, 0x80800000u,
      0x00800001u, 0x3f800000u, 0xbf800000u, 0x3effffffu, 0x3f000000u, 0x7f7fffffu, 0xff7fffffu, 0x7f800000u,
      0xff800000u, 0x7fc00000u, 0xffc00000u, 0x7f800001u, 0xff812345u, 0x7fffffffu, 0x4b000000u, 0x4b800000u};
  std::mt19937 random(2);
  const auto number = [&]() -> uint32_t {
    switch (random() % 4) {
      case 0:
        return random();
      case 1:
        return special[random() % std::size(special)];
      case 2:
        return random() & 0x807fffffu;
      default:
        return (random() & 0x807fffffu) | (96 + random() % 64) << 23;
    }
  };
  std::vector<uvec4> vectors(vector_count);
  for (uvec4& v : vectors) v = uvec4(number(), number(), number(), number());
  return vectors;
}

class Conformance : public SetupTest {
 protected:
  void SetUp() override {
    SetupTest::SetUp();
    if (IsSkipped()) return;
    HostOptions options = host_options();
    options.kernels = kernels::all_kernels();
    backend_ = make(options);
    operands_ = render::Buffer(*backend_, {"operands", vector_count, 16});
    results_ = render::Buffer(*backend_, {"results", vector_count, 4});
  }
  void TearDown() override {
    operands_ = {};
    results_ = {};
    if (backend_) backend_->finish();
    backend_.reset();
    SetupTest::TearDown();
  }

  void load(const std::vector<uvec4>& vectors) {
    backend_->upload(operands_.id(), std::as_bytes(std::span(vectors)));
  }

  std::vector<uint32_t> device_results(uint32_t op, bool flush) {
    static constexpr render::Binding bindings[] = {
        {"operands", render::BindingKind::quad, render::Access::read},
        {"results", render::BindingKind::word, render::Access::write}};
    static constexpr render::PassDecl pass{"conformance", "conformance/arithmetic", bindings, 4, 64};
    const render::BufferId buffers[] = {operands_.id(), results_.id()};
    render::Dispatch dispatch;
    dispatch.pass = &pass;
    dispatch.buffers = buffers;
    dispatch.push = std::as_bytes(std::span(&vector_count, 1));
    dispatch.invocations = vector_count;
    dispatch.constants = {op, flush ? 1u : 0u, 0, 0};
    backend_->run(dispatch);
    return download_words(*backend_, results_.id(), vector_count);
  }

  // The vectors whose result differs, NaN apart.
  std::vector<size_t> differing(uint32_t op, const std::vector<uvec4>& vectors, bool flush) {
    const std::vector<uint32_t> got = device_results(op, flush);
    std::vector<size_t> found;
    for (size_t i = 0; i < vectors.size(); ++i) {
      const uint32_t expected = host_result(op, vectors[i], flush);
      if (got[i] != expected && !(is_nan(got[i]) && is_nan(expected))) found.push_back(i);
    }
    return found;
  }

  static std::string describe(uint32_t op, const uvec4& v) {
    char text[120];
    std::snprintf(text, sizeof(text), "%s of %08x %08x %08x %08x", operation_names[op], v.x, v.y, v.z, v.w);
    return text;
  }

  std::unique_ptr<render::Backend> backend_;
  render::Buffer operands_, results_;
};

INSTANTIATE_TEST_SUITE_P(
    Devices, Conformance,
    testing::Values(Setup{"lavapipe_texel", Driver::lavapipe, TexelBuffers::always, true},
                    Setup{"lavapipe_no_pairs", Driver::lavapipe, TexelBuffers::without_pairs, true},
                    Setup{"lavapipe_plain", Driver::lavapipe, TexelBuffers::never, true},
                    Setup{"swiftshader", Driver::swiftshader, TexelBuffers::automatic, true}),
    setup_name);

TEST_P(Conformance, AllOperationsAreEqualOnModerateNumbers) {
  const std::vector<uvec4> vectors = moderate_vectors();
  load(vectors);
  for (uint32_t op = 0; op < layout::op_count; ++op) {
    const std::vector<size_t> found = differing(op, vectors, false);
    EXPECT_TRUE(found.empty()) << found.size() << " differ; " << describe(op, vectors[found.front()]);
  }
}

TEST_P(Conformance, SingleOperationsAreEqualOnAllNumbersWhereDenormalsAreFlushed) {
  const std::vector<uvec4> vectors = extreme_vectors();
  load(vectors);
  for (uint32_t op = 0; op < layout::op_count; ++op) {
    if (is_compound(op) || is_integer(op)) continue;
    const std::vector<size_t> found = differing(op, vectors, true);
    EXPECT_TRUE(found.empty()) << found.size() << " differ; " << describe(op, vectors[found.front()]);
  }
}

TEST_P(Conformance, IntegersAreEqualOnAllNumbers) {
  const std::vector<uvec4> vectors = extreme_vectors();
  load(vectors);
  for (uint32_t op = 0; op < layout::op_count; ++op) {
    if (!is_integer(op)) continue;
    const std::vector<size_t> found = differing(op, vectors, false);
    EXPECT_TRUE(found.empty()) << found.size() << " differ; " << describe(op, vectors[found.front()]);
  }
}

TEST_P(Conformance, UnflushedOperationsDifferOnlyWhereADenormalIsInvolved) {
  const std::vector<uvec4> vectors = extreme_vectors();
  load(vectors);
  for (uint32_t op = 0; op < layout::op_count; ++op) {
    if (is_compound(op) || is_integer(op)) continue;
    const std::vector<size_t> found = differing(op, vectors, false);
    if (!found.empty()) {
      std::printf("  %s: %s differs for %zu of %u vectors, all with denormals\n",
                  backend_->info().name.c_str(), operation_names[op], found.size(), vector_count);
    }
    for (const size_t i : found) {
      const uvec4& v = vectors[i];
      ASSERT_TRUE(is_tiny(v.x) || is_tiny(v.y) || is_tiny(host_result(op, v, false))) << describe(op, v);
    }
  }
}

TEST_P(Conformance, LoadsStoresAndCastsKeepEveryBit) {
  const std::vector<uvec4> vectors = extreme_vectors();
  load(vectors);
  const std::vector<uint32_t> got = device_results(layout::op_round_trip, false);
  for (size_t i = 0; i < vectors.size(); ++i) ASSERT_EQ(got[i], vectors[i].x);
}

}  // namespace
}  // namespace lodestone::host
