// SPDX-License-Identifier: MIT
// What a kernel asks of a device, read from its SPIR-V.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lodestone/host/physical_device.h"

namespace lodestone::host {

// The capabilities that the module declares and the device lacks, as a user would call them.
std::vector<std::string> find_unmet_needs(std::span<const uint32_t> module, const PhysicalDevice& device);

}  // namespace lodestone::host
