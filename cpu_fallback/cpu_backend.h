// SPDX-License-Identifier: MIT
// The back end that needs no device: every pass as native code over the same buffers, on all cores.
#pragma once

#include <memory>
#include <string>

#include "lodestone/render/backend.h"

namespace lodestone::cpu_fallback {

std::unique_ptr<render::Backend> make_cpu_backend(const render::BackendOptions& options);

// The SIMD instruction set that run-time dispatch chose, e.g. "AVX3".
std::string simd_target();

}  // namespace lodestone::cpu_fallback
