// SPDX-License-Identifier: MIT
#include <atomic>

#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/detail_nodes.h"

namespace lodestone::cpu_fallback {
namespace {

using namespace layout;

class Radii {
 public:
  explicit Radii(Words words) : words_(words) {}
  float operator[](uint32_t point) const {
    return uintBitsToFloat(std::atomic_ref<uint32_t>(words_.words[point]).load(std::memory_order_relaxed));
  }
  void raise(uint32_t point, float radius) const {
    const std::atomic_ref<uint32_t> word(words_.words[point]);
    const uint32_t bits = floatBitsToUint(radius);  // which order like integers
    uint32_t before = word.load(std::memory_order_relaxed);
    while (before < bits && !word.compare_exchange_weak(before, bits, std::memory_order_relaxed)) {
    }
  }

 private:
  Words words_;
};

template <class Probe>
class CoarseNodes : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

 protected:
  Quads coarse_nodes = this->quads(0), geometry = this->quads(1);
  Words collapses = this->words(2), points = this->words(3);
  Quads node_details = this->quads(4);
  Radii radii{this->words(5)};
  DetailPush push_ = this->template push<DetailPush>();

#define LOAD4(result, buffer, i) result = this->load(buffer, i)
#define LOAD1(result, buffer, i) result = this->load(buffer, i)
#define STORE4(buffer, i, value) this->store(buffer, i, value)
#define RADIUS(point) radii[point]
#define RAISE(point, radius) radii.raise(point, radius)
#include "lodestone/layout/coarse_nodes.h"
#undef LOAD4
#undef LOAD1
#undef STORE4
#undef RADIUS
#undef RAISE
};

template <class Probe>
class DetailBegin : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;
  void operator()(uint32_t texel) {
    const bool fixed = this->load(collapses_, 2 * uint64_t(texel)) == texel;
    radii_.store1(texel, floatBitsToUint(fixed ? fixed_radius : least_radius));
  }

 private:
  Words collapses_ = this->words(0), radii_ = this->words(1);
};

template <class Probe>
class DetailMeasure : public CoarseNodes<Probe> {
 public:
  using CoarseNodes<Probe>::CoarseNodes;
  void operator()(uint32_t index) { this->measure_node(this->push_.first + index); }
};

template <class Probe>
class DetailSettle : public CoarseNodes<Probe> {
 public:
  using CoarseNodes<Probe>::CoarseNodes;
  void operator()(uint32_t index) {
    this->settle_node(this->load(order_, this->push_.first + index), this->push_.steepest);
  }

 private:
  Words order_ = this->words(6);
};

template <class Probe>
class DetailEnd : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;
  void operator()(uint32_t texel) {
    this->store(collapses_, 2 * uint64_t(texel) + 1, radii_.load1(this->load(points_, texel)));
  }

 private:
  Words collapses_ = this->words(0), points_ = this->words(1), radii_ = this->words(2);
};

LODESTONE_BLOCK_FUNCTION(static, detail_begin, DetailBegin)
LODESTONE_BLOCK_FUNCTION(static, detail_measure, DetailMeasure)
LODESTONE_BLOCK_FUNCTION(static, detail_settle, DetailSettle)
LODESTONE_BLOCK_FUNCTION(static, detail_end, DetailEnd)

}  // namespace

void detail_begin(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 4096, detail_begin_block);
}
void detail_measure(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 1024, detail_measure_block);
}
void detail_settle(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 1024, detail_settle_block);
}
void detail_end(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 4096, detail_end_block);
}

}  // namespace lodestone::cpu_fallback
