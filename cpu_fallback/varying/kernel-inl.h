// SPDX-License-Identifier: MIT
// How a pass is written for invocations side by side: a class whose call operator is as many of them as a
// vector has lanes. What it loads, stores and counts it does for the active ones.
// Included once a SIMD target.

#if defined(LODESTONE_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_KERNEL_INL_H_
#undef LODESTONE_KERNEL_INL_H_
#else
#define LODESTONE_KERNEL_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "lodestone/cpu_fallback/kernel.h"
#include "lodestone/cpu_fallback/varying/layout-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Where;

template <class Probe>
class VaryingKernel : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  // Which invocations the next call is.
  HWY_ATTR void begin(uint32_t first, uint32_t count) {
    first_ = first;
    activate(first_lanes(count));
    if (list_ == nullptr) return;
    for (uint32_t lane = 0; lane < lane_count; ++lane)
      own_.at[lane] = list_[first + std::min(lane, count - 1)];
    count_read(1);
  }

 protected:
  // From now on invocation i stands for element list[i].
  void stand_for(const uint32_t* list) { list_ = list; }

  // Their numbers.
  HWY_ATTR uvec1 own_index() const {
    if (list_ != nullptr) return own_.lanes();
    return hn::Iota(Unsigneds(), first_);
  }

  HWY_ATTR bvec1 active() const { return active_; }
  uint32_t active_count() const { return static_cast<uint32_t>(std::popcount(bits_)); }

  // Calls body(value) for each value that `key` has in active invocations, with those active that have it.
  template <class Body>
  HWY_ATTR void for_each_value(uvec1 key, const Body& body) {
    const LaneWords keys(key);
    for (uint32_t left = bits_; left != 0;) {
      const uint32_t value = keys.at[std::countr_zero(left)];
      const Where here(*this, key == value);
      left &= ~bits_;
      body(value);
    }
  }

  // Quad or word i * stride + offset of a buffer. What inactive invocations load is 0.
  HWY_ATTR uvec4 load(const Quads& buffer, uvec1 i, uint32_t stride = 1, uint32_t offset = 0) {
    count_read(4);
    const LaneWords at(i);
    return gather(buffer, [&](uint32_t lane) HWY_ATTR { return uint64_t{at.at[lane]} * stride + offset; });
  }
  HWY_ATTR uvec1 load(const Words& buffer, uvec1 i, uint32_t stride = 1, uint32_t offset = 0) {
    count_read(1);
    LaneWords at(i);
    for (uint32_t lane = 0; lane < lane_count; ++lane) {
      at.at[lane] = is_active(lane) ? buffer.words[uint64_t{at.at[lane]} * stride + offset] : uint32_t{0};
    }
    return at.lanes();
  }
  HWY_ATTR void store(const Quads& buffer, uvec1 i, const uvec4& value, uint32_t stride = 1,
                      uint32_t offset = 0) {
    const LaneWords at(i);
    scatter(buffer, value, [&](uint32_t lane) HWY_ATTR { return uint64_t{at.at[lane]} * stride + offset; });
  }
  HWY_ATTR void store(const Words& buffer, uvec1 i, uvec1 value, uint32_t stride = 1, uint32_t offset = 0) {
    count_write(1);
    const LaneWords at(i), words(value);
    for (uint32_t left = bits_; left != 0; left &= left - 1) {
      const auto lane = static_cast<uint32_t>(std::countr_zero(left));
      buffer.words[uint64_t{at.at[lane]} * stride + offset] = words.at[lane];
    }
  }

  // The same with the invocation's own number for i, which is faster.
  HWY_ATTR uvec4 load_own(const Quads& buffer, uint32_t stride = 1, uint32_t offset = 0) {
    count_read(4);
    return gather(buffer, [&](uint32_t lane) HWY_ATTR { return own_place(lane) * stride + offset; });
  }
  HWY_ATTR void store_own(const Quads& buffer, const uvec4& value, uint32_t stride = 1, uint32_t offset = 0) {
    scatter(buffer, value, [&](uint32_t lane) HWY_ATTR { return own_place(lane) * stride + offset; });
  }

  // Words an active invocation.
  void count_read(uint32_t words) { this->probe.read(words * active_count()); }
  void count_write(uint32_t words) { this->probe.write(words * active_count()); }

 private:
  friend Where<Probe>;

  HWY_ATTR void activate(bvec1 active) {
    active_ = active;
    bits_ = lane_bits(active);
  }

  bool is_active(uint32_t lane) const { return (bits_ >> lane & 1) != 0; }
  uint64_t own_place(uint32_t lane) const {
    return list_ != nullptr ? own_.at[lane] : uint64_t{first_} + lane;
  }

  // `place`: the quad of a lane.
  template <class Place>
  HWY_ATTR uvec4 gather(const Quads& buffer, const Place& place) {
    const uint32_t* from[lane_count];
    if (HWY_LIKELY(bits_ == all_bits)) {
      for (uint32_t lane = 0; lane < lane_count; ++lane) from[lane] = buffer.words + 4 * place(lane);
    } else {
      static constexpr uint32_t nothing[4] = {};
      for (uint32_t lane = 0; lane < lane_count; ++lane) {
        from[lane] = is_active(lane) ? buffer.words + 4 * place(lane) : nothing;
      }
    }
    return load_quads(from);
  }
  // Inline also where a pass is there for one source and for three (surface_kernel-inl.h), or it would cost
  // that of one 6 % more instructions.
  template <class Place>
  HWY_INLINE HWY_ATTR void scatter(const Quads& buffer, const uvec4& value, const Place& place) {
    count_write(4);
    alignas(64) uint32_t quads[4 * lane_count];
    hn::StoreInterleaved4(value.x.v, value.y.v, value.z.v, value.w.v, Unsigneds(), quads);
    for (uint32_t left = bits_; left != 0; left &= left - 1) {
      const auto lane = static_cast<uint32_t>(std::countr_zero(left));
      std::memcpy(buffer.words + 4 * place(lane), quads + 4 * lane, 16);
    }
  }

  static constexpr uint32_t all_bits = (1u << lane_count) - 1;

  uint32_t first_ = 0;  // invocation
  const uint32_t* list_ = nullptr;
  LaneWords own_{uvec1(0u)};  // of list_
  bvec1 active_;
  uint32_t bits_ = 0;  // of active_
};

// As long as it lives only those of a pass's active invocations do anything for which `condition` holds.
template <class Probe>
class Where {
 public:
  HWY_ATTR Where(VaryingKernel<Probe>& kernel, bvec1 condition) : kernel_(kernel), before_(kernel.active_) {
    kernel.activate(before_ && condition);
  }
  HWY_ATTR ~Where() { kernel_.activate(before_); }
  Where(const Where&) = delete;
  Where& operator=(const Where&) = delete;
  bool any() const { return kernel_.bits_ != 0; }

 private:
  VaryingKernel<Probe>& kernel_;
  bvec1 before_;
};

// Defines NAME_block, a BlockFunction (kernel.h), for the pass template PASS.
#define LODESTONE_VARYING_BLOCK_FUNCTION(NAME, PASS)                                    \
  HWY_ATTR void NAME##_block(const CpuDispatch& dispatch, uint32_t begin, uint32_t end, \
                             render::Counters* counters) {                              \
    if (counters == nullptr) {                                                          \
      run_lanes<PASS<EmptyProbe>>(dispatch, begin, end);                                \
    } else {                                                                            \
      *counters = run_lanes<PASS<CountingProbe>>(dispatch, begin, end).counts;          \
    }                                                                                   \
  }

template <class Pass>
HWY_ATTR auto run_lanes(const CpuDispatch& dispatch, uint32_t begin, uint32_t end) {
  Pass pass(dispatch);
  for (uint32_t first = begin; first < end;) {
    const uint32_t count = std::min(lane_count, end - first);
    pass.begin(first, count);
    pass();
    first += count;
  }
  return pass.probe;
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
