// SPDX-License-Identifier: MIT
// The Vulkan devices of this machine, as a user sees and chooses them.
#pragma once

#include <string>
#include <vector>

#include "lodestone/host/instance.h"
#include "lodestone/host/physical_device.h"
#include "lodestone/render/backend.h"

namespace lodestone::host {

// Whether word and quad buffers become texel buffers; without_pairs: those that are only written as well,
// whatever the device.
enum class TexelBuffers { automatic, always, without_pairs, never };

// A line of `lodestone devices`.
struct DeviceProperty {
  std::string name;   // "subgroup size"
  std::string value;  // "8"
};

struct DeviceDetails : render::DeviceInfo {
  std::vector<std::string> unusable;       // what this program cannot do without; empty: usable
  std::vector<DeviceProperty> properties;  // for display
};

// Whether word and quad buffers become texel buffers.
bool uses_texel_buffers(const PhysicalDevice& device, TexelBuffers choice);

DeviceDetails describe_device(const PhysicalDevice& device, uint32_t index, bool texel_buffers);

// All Vulkan devices, the usable and the others; empty where there is no driver.
std::vector<DeviceDetails> list_devices();

// The device that `selector` names: "gpu" (the first), its index in list_devices(), or a part of its name in
// any case of letters. Throws Error(device) listing what was found, what it lacks and which driver files were
// tried.
uint32_t select_device(const std::vector<DeviceDetails>& devices, const std::string& selector);

}  // namespace lodestone::host
