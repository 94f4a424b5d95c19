// SPDX-License-Identifier: MIT
// What a Vulkan device is and can do, asked for once.
#pragma once

#include <vulkan/vulkan.h>

#include <optional>
#include <string>
#include <vector>

namespace lodestone::host {

struct PhysicalDevice {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceVulkan11Properties properties11{};
  VkPhysicalDeviceVulkan12Properties properties12{};
  VkPhysicalDeviceFeatures features{};
  VkPhysicalDeviceVulkan11Features features11{};
  VkPhysicalDeviceVulkan12Features features12{};
  VkPhysicalDeviceMemoryProperties memory{};
  std::vector<std::string> extensions;
  uint64_t max_buffer_size = 0;          // of one VkBuffer, bytes
  std::optional<uint32_t> queue_family;  // one that computes; without graphics where there is a choice
  uint32_t timestamp_bits = 0;           // of that family; 0: no timestamps
  bool texel_formats = false;            // R32_UINT and R32G32B32A32_UINT as storage texel buffers

  const VkPhysicalDeviceLimits& limits() const { return properties.limits; }
  std::string name() const { return properties.deviceName; }
  bool has_extension(const char* extension) const;
  // Device and host share their memory, so that mapped memory is as fast as any.
  bool shares_memory() const;
  // Mesa's llvmpipe before 23 stops an invocation after 65,535 loop iterations without a word.
  bool cuts_loops() const;
};

PhysicalDevice query_physical_device(VkPhysicalDevice device);

// What this program cannot do without and the device lacks; empty: usable.
std::vector<std::string> missing_requirements(const PhysicalDevice& device);

}  // namespace lodestone::host
