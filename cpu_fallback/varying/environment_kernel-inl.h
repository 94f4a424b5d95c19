// SPDX-License-Identifier: MIT
// The buffers that layout/environment.h reads, in two slots from `slot` on, that header itself and what
// stands on it. Included once a SIMD target.

#if defined(LODESTONE_ENVIRONMENT_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_ENVIRONMENT_KERNEL_INL_H_
#undef LODESTONE_ENVIRONMENT_KERNEL_INL_H_
#else
#define LODESTONE_ENVIRONMENT_KERNEL_INL_H_
#endif

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

// `Base` is a VaryingKernel that has `frames`. The dispatch's third constant is `environment_map`.
template <class Base, size_t slot>
class EnvironmentKernel : public Base {
 public:
  using Base::Base;

 protected:
  using Base::frames;
  Quads environment_quads = this->quads(slot);
  Words environment_cells = this->words(slot + 1);
  uint32_t environment_map = this->constant(2);

#define LOAD4(result, buffer, i) result = this->load(buffer, i)
#define LOAD1(result, buffer, i) result = this->load(buffer, i)
#include "lodestone/layout/environment.h"
#include "lodestone/layout/sky_light.h"
#undef LOAD4
#undef LOAD1
};

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
