// SPDX-License-Identifier: MIT
#include "lodestone/host/physical_device.h"

#include <algorithm>
#include <limits>

namespace lodestone::host {

namespace {

void query_properties(PhysicalDevice& device) {
  device.properties11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES;
  device.properties12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES;
  VkPhysicalDeviceMaintenance4Properties largest_buffer{};
  largest_buffer.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES;
  VkPhysicalDeviceProperties2 all{};
  all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  all.pNext = &device.properties11;
  device.properties11.pNext = &device.properties12;
  const bool asks_for_buffers = device.properties.apiVersion >= VK_API_VERSION_1_3;
  if (asks_for_buffers) device.properties12.pNext = &largest_buffer;
  vkGetPhysicalDeviceProperties2(device.handle, &all);
  device.properties11.pNext = device.properties12.pNext = nullptr;
  device.max_buffer_size = asks_for_buffers && largest_buffer.maxBufferSize != 0
                               ? largest_buffer.maxBufferSize
                               : std::numeric_limits<uint64_t>::max();
  device.max_buffer_size = std::min(device.max_buffer_size, device.properties11.maxMemoryAllocationSize);
}

void query_features(PhysicalDevice& device) {
  device.features11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
  device.features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  VkPhysicalDeviceFeatures2 all{};
  all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  all.pNext = &device.features11;
  device.features11.pNext = &device.features12;
  vkGetPhysicalDeviceFeatures2(device.handle, &all);
  device.features = all.features;
  device.features11.pNext = device.features12.pNext = nullptr;
}

void query_queue(PhysicalDevice& device) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, families.data());
  for (const bool wants_graphics : {false, true}) {
    for (uint32_t i = 0; i < count; ++i) {
      const VkQueueFlags flags = families[i].queueFlags;
      const bool has_graphics = (flags & VK_QUEUE_GRAPHICS_BIT) != 0;
      if (device.queue_family || (flags & VK_QUEUE_COMPUTE_BIT) == 0 || has_graphics != wants_graphics)
        continue;
      device.queue_family = i;
      device.timestamp_bits = families[i].timestampValidBits;
    }
  }
}

bool is_storage_texel_format(VkPhysicalDevice device, VkFormat format) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device, format, &properties);
  return (properties.bufferFeatures & VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT) != 0;
}

}  // namespace

PhysicalDevice query_physical_device(VkPhysicalDevice handle) {
  PhysicalDevice device;
  device.handle = handle;
  vkGetPhysicalDeviceProperties(handle, &device.properties);
  vkGetPhysicalDeviceMemoryProperties(handle, &device.memory);
  query_queue(device);
  if (device.properties.apiVersion < VK_API_VERSION_1_2) return device;
  query_properties(device);
  query_features(device);
  uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(handle, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateDeviceExtensionProperties(handle, nullptr, &count, extensions.data());
  for (const VkExtensionProperties& extension : extensions)
    device.extensions.emplace_back(extension.extensionName);
  device.texel_formats = is_storage_texel_format(handle, VK_FORMAT_R32_UINT) &&
                         is_storage_texel_format(handle, VK_FORMAT_R32G32B32A32_UINT);
  return device;
}

bool PhysicalDevice::has_extension(const char* extension) const {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

bool PhysicalDevice::shares_memory() const {
  return properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU ||
         properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;
}

bool PhysicalDevice::cuts_loops() const {
  return properties12.driverID == VK_DRIVER_ID_MESA_LLVMPIPE &&
         VK_API_VERSION_MAJOR(properties.driverVersion) < 23;
}

std::vector<std::string> missing_requirements(const PhysicalDevice& device) {
  std::vector<std::string> missing;
  if (device.properties.apiVersion < VK_API_VERSION_1_2) missing.emplace_back("Vulkan 1.2");
  if (!device.queue_family) missing.emplace_back("a queue that computes");
  if (device.properties.apiVersion >= VK_API_VERSION_1_2 && device.features12.scalarBlockLayout == VK_FALSE) {
    missing.emplace_back("scalar block layout");
  }
  return missing;
}

}  // namespace lodestone::host
