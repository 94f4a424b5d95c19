// SPDX-License-Identifier: MIT
// One arithmetic for all devices: what a kernel may compute so that lavapipe, SwiftShader and the CPU give
// equal bits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spirv_module.h"

namespace lodestone::spirv {

// A line for each instruction whose bits depend on the device: built-in functions other than square root,
// floor, ceiling, truncation, rounding to even, absolute value and the integer ones; products with matrices;
// float reductions over a subgroup or by atomics; filtered images; float operations with a constant zero
// (lavapipe folds x + 0, 0 - x and x * 0, which drops the sign of a zero and NaN).
std::vector<std::string> find_unportable(const Module& module);

// The module with NoContraction on every float operation, so that no driver may fuse or re-associate.
std::vector<uint32_t> forbid_contraction(const Module& module);

}  // namespace lodestone::spirv
