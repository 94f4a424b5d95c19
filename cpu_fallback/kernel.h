// SPDX-License-Identifier: MIT
// How a pass is written in C++: a struct, templated over the memory probe, whose members are views of the
// buffers and whose call operator is one invocation. The probe sees every access; the empty one costs
// nothing, the counting one fills the counters.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <span>

#include "lodestone/base/parallel.h"
#include "lodestone/layout/types.h"
#include "lodestone/render/backend.h"

namespace lodestone::cpu_fallback {

struct CpuDispatch {
  std::span<uint32_t* const> buffers;  // one a binding
  std::span<const std::byte> push;
  uint32_t invocations = 0;
  std::array<uint32_t, render::pass_constants> constants{};
  bool counting = false;
  render::Counters* counters = nullptr;
};

using CpuPass = void (*)(const CpuDispatch&);

struct EmptyProbe {
  static constexpr bool counting = false;
  void read(uint32_t) {}
  void write(uint32_t) {}
  void step(uint32_t) {}
  void triangles(uint32_t) {}
  void ray() {}
};

struct CountingProbe {
  static constexpr bool counting = true;
  render::Counters counts;
  void read(uint32_t words) { counts.bytes_read += 4 * words; }
  void write(uint32_t words) { counts.bytes_written += 4 * words; }
  void step(uint32_t boxes) {  // of one ray; a single ray is a subgroup of one
    counts.node_visits += boxes;
    counts.box_tests += boxes;
    ++counts.lane_steps;
    ++counts.subgroup_steps;
  }
  void triangles(uint32_t count) { counts.triangle_tests += count; }
  void ray() { ++counts.rays; }
};

void add_counters(render::Counters& sum, const render::Counters& more);

struct Quads {
  uint32_t* words;
  glm::uvec4 load4(uint64_t i) const {
    glm::uvec4 value;
    std::memcpy(&value, words + 4 * i, 16);
    return value;
  }
  void store4(uint64_t i, const glm::uvec4& value) const { std::memcpy(words + 4 * i, &value, 16); }
};

struct Words {
  uint32_t* words;
  uint32_t load1(uint64_t i) const { return words[i]; }
  void store1(uint64_t i, uint32_t value) const { words[i] = value; }
};

template <class T>
struct Structs {
  const T* items;
  const T& operator[](uint64_t i) const { return items[i]; }
};

inline glm::vec3 as_vec3(const glm::uvec4& bits) {
  return {layout::uintBitsToFloat(bits.x), layout::uintBitsToFloat(bits.y), layout::uintBitsToFloat(bits.z)};
}
inline glm::vec4 as_vec4(const glm::uvec4& bits) {
  return glm::vec4(as_vec3(bits), layout::uintBitsToFloat(bits.w));
}
inline glm::uvec4 as_bits(const glm::vec3& v, uint32_t w) {
  return {layout::floatBitsToUint(v.x), layout::floatBitsToUint(v.y), layout::floatBitsToUint(v.z), w};
}

// The base of every pass: its probe, and the constants and buffers of the dispatch.
template <class ProbeType>
class Kernel {
 public:
  explicit Kernel(const CpuDispatch& dispatch) : dispatch_(dispatch) {}
  ProbeType probe;

 protected:
  Quads quads(size_t slot) const { return {dispatch_.buffers[slot]}; }
  Words words(size_t slot) const { return {dispatch_.buffers[slot]}; }
  template <class T>
  Structs<T> structs(size_t slot) const {
    return {reinterpret_cast<const T*>(dispatch_.buffers[slot])};
  }
  template <class T>
  T push() const {
    T value;
    std::memcpy(&value, dispatch_.push.data(), sizeof(T));
    return value;
  }
  uint32_t constant(size_t i) const { return dispatch_.constants[i]; }

  void count_read(uint32_t count) { probe.read(count); }
  glm::uvec4 load(const Quads& buffer, uint64_t i) {
    probe.read(4);
    return buffer.load4(i);
  }
  uint32_t load(const Words& buffer, uint64_t i) {
    probe.read(1);
    return buffer.load1(i);
  }
  void store(const Quads& buffer, uint64_t i, const glm::uvec4& value) {
    probe.write(4);
    buffer.store4(i, value);
  }
  void store(const Words& buffer, uint64_t i, uint32_t value) {
    probe.write(1);
    buffer.store1(i, value);
  }
  // The same for vector loads and stores.
  const float* loaded(const Quads& buffer, uint64_t i) {
    probe.read(4);
    return reinterpret_cast<const float*>(buffer.words + 4 * i);
  }
  uint32_t* stored(const Quads& buffer, uint64_t i) {
    probe.write(4);
    return buffer.words + 4 * i;
  }
  // A counter that several invocations add to.
  void add(const Words& buffer, uint64_t i, uint32_t value) {
    std::atomic_ref<uint32_t>(buffer.words[i]).fetch_add(value, std::memory_order_relaxed);
  }

 private:
  const CpuDispatch& dispatch_;
};

// Invocations [begin, end) of a pass; `counters`: null, or what they are added to.
using BlockFunction = void (*)(const CpuDispatch& dispatch, uint32_t begin, uint32_t end,
                               render::Counters* counters);

// Every invocation of a pass, in blocks of `grain`. Where the pass is compiled once a SIMD target, `block` is
// the one that run-time dispatch chose.
inline void run_blocks(const CpuDispatch& dispatch, uint64_t grain, BlockFunction block) {
  std::mutex mutex;
  parallel_for(dispatch.invocations, grain, [&](uint64_t begin, uint64_t end) {
    render::Counters counters;
    block(dispatch, static_cast<uint32_t>(begin), static_cast<uint32_t>(end),
          dispatch.counting ? &counters : nullptr);
    if (!dispatch.counting) return;
    const std::lock_guard lock(mutex);
    add_counters(*dispatch.counters, counters);
  });
}

// Defines NAME_block, a BlockFunction, for the pass template PASS. ATTRIBUTES: HWY_ATTR where it is compiled
// once a SIMD target, else static.
#define LODESTONE_BLOCK_FUNCTION(ATTRIBUTES, NAME, PASS)                                  \
  ATTRIBUTES void NAME##_block(const CpuDispatch& dispatch, uint32_t begin, uint32_t end, \
                               render::Counters* counters) {                              \
    if (counters == nullptr) {                                                            \
      PASS<EmptyProbe> pass(dispatch);                                                    \
      for (uint32_t i = begin; i < end; ++i) pass(i);                                     \
    } else {                                                                              \
      PASS<CountingProbe> pass(dispatch);                                                 \
      for (uint32_t i = begin; i < end; ++i) pass(i);                                     \
      *counters = pass.probe.counts;                                                      \
    }                                                                                     \
  }

}  // namespace lodestone::cpu_fallback
