// SPDX-License-Identifier: MIT
// The headers of shaders/layout that invocations side by side need, compiled over numbers-inl.h. Records that
// are the same for all invocations (layout/frame.h) and constants stay what they are. Included once a SIMD
// target.

#if defined(LODESTONE_LAYOUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_LAYOUT_INL_H_
#undef LODESTONE_LAYOUT_INL_H_
#else
#define LODESTONE_LAYOUT_INL_H_
#endif

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/numbers-inl.h"
#include "lodestone/layout/camera.h"
#include "lodestone/layout/denoise.h"
#include "lodestone/layout/detail.h"
#include "lodestone/layout/emitters.h"
#include "lodestone/layout/motion.h"
#include "lodestone/layout/path.h"
#include "lodestone/layout/ray_state.h"
#include "lodestone/layout/recursion.h"
#include "lodestone/layout/shading.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
using namespace layout;  // behind what is declared here
}

#undef LODESTONE_LAYOUT_ARITHMETIC_H
#undef LODESTONE_LAYOUT_ATLAS_H
#undef LODESTONE_LAYOUT_BSDF_H
#undef LODESTONE_LAYOUT_CAMERA_H
#undef LODESTONE_LAYOUT_DENOISE_H
#undef LODESTONE_LAYOUT_DETAIL_H
#undef LODESTONE_LAYOUT_EMITTERS_H
#undef LODESTONE_LAYOUT_MOTION_H
#undef LODESTONE_LAYOUT_PATH_H
#undef LODESTONE_LAYOUT_RAY_H
#undef LODESTONE_LAYOUT_RAY_STATE_H
#undef LODESTONE_LAYOUT_RECURSION_H
#undef LODESTONE_LAYOUT_SAMPLING_H
#undef LODESTONE_LAYOUT_SHADING_H
#undef LODESTONE_LAYOUT_BEGIN
#define LODESTONE_LAYOUT_BEGIN namespace lodestone::cpu_fallback::HWY_NAMESPACE {
#include "lodestone/layout/arithmetic.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/layout/bsdf.h"
#include "lodestone/layout/camera.h"
#include "lodestone/layout/denoise.h"
#include "lodestone/layout/detail.h"
#include "lodestone/layout/emitters.h"
#include "lodestone/layout/motion.h"
#include "lodestone/layout/path.h"
#include "lodestone/layout/ray.h"
#include "lodestone/layout/ray_state.h"
#include "lodestone/layout/recursion.h"
#include "lodestone/layout/sampling.h"
#include "lodestone/layout/shading.h"
#undef LODESTONE_LAYOUT_BEGIN
#define LODESTONE_LAYOUT_BEGIN namespace lodestone::layout {
HWY_AFTER_NAMESPACE();
#endif
