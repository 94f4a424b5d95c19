// SPDX-License-Identifier: MIT
// The software devices of a test machine. Every one that is there must be used; SwiftShader may be absent.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lodestone/render/backend.h"

namespace lodestone::test {

// "cpu", "llvmpipe" and, where $LODESTONE_SWIFTSHADER_ICD names its driver file, "SwiftShader".
std::vector<std::string> device_names();

// The same without "cpu".
std::vector<std::string> vulkan_device_names();

// For what takes long and whose passes the parity tests compare to the bit on every device: SwiftShader,
// which compiles slowly, only where $LODESTONE_ALL_TESTS is set (scripts/test --all).
std::vector<std::string> judged_device_names();

// Throws Error(device).
std::unique_ptr<render::Backend> open(const std::string& name, const render::BackendOptions& options = {});

// A Vulkan device that makes no buffer larger than this: longer arrays are split over several.
std::unique_ptr<render::Backend> open_split(const std::string& name, uint64_t max_buffer_bytes,
                                            const render::BackendOptions& options = {});

}  // namespace lodestone::test
