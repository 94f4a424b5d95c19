// SPDX-License-Identifier: MIT
// The buffers that layout/denoise_filter.h reads, slots 0 and 1 of the filtering passes, and that header
// itself. Included once a SIMD target.

#if defined(LODESTONE_DENOISE_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_DENOISE_KERNEL_INL_H_
#undef LODESTONE_DENOISE_KERNEL_INL_H_
#else
#define LODESTONE_DENOISE_KERNEL_INL_H_
#endif

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

// An invocation is a pixel, row by row.
template <class Probe>
class DenoiseKernel : public VaryingKernel<Probe> {
 public:
  using VaryingKernel<Probe>::VaryingKernel;

 protected:
  HWY_ATTR uvec1 own_x() const { return this->own_index() % grid.width; }
  HWY_ATTR uvec1 own_y() const { return this->own_index() / grid.width; }

  Quads guides = this->quads(0), light = this->quads(1), filtered = this->quads(2);
  DenoisePush grid = this->template push<DenoisePush>();

#define LOAD4(result, buffer, i) result = this->load(buffer, i)
#include "lodestone/layout/denoise_filter.h"
#undef LOAD4
};

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
