// SPDX-License-Identifier: MIT
#include "lodestone/host/device.h"

#include <algorithm>
#include <array>
#include <vector>

#include "lodestone/host/check.h"

namespace lodestone::host {

namespace {

// Everything that spares a fast kernel variant a detour, and nothing that makes buffers slower.
struct EnabledFeatures {
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceVulkan11Features vulkan11{};
  VkPhysicalDeviceVulkan12Features vulkan12{};

  explicit EnabledFeatures(const PhysicalDevice& has) {
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    core.pNext = &vulkan11;
    core.features.shaderInt64 = has.features.shaderInt64;
    core.features.shaderInt16 = has.features.shaderInt16;
    core.features.shaderFloat64 = has.features.shaderFloat64;
    vulkan11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
    vulkan11.pNext = &vulkan12;
    vulkan11.storageBuffer16BitAccess = has.features11.storageBuffer16BitAccess;
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12.scalarBlockLayout = VK_TRUE;
    vulkan12.storageBuffer8BitAccess = has.features12.storageBuffer8BitAccess;
    vulkan12.shaderBufferInt64Atomics = has.features12.shaderBufferInt64Atomics;
    vulkan12.shaderFloat16 = has.features12.shaderFloat16;
    vulkan12.shaderInt8 = has.features12.shaderInt8;
    vulkan12.shaderSubgroupExtendedTypes = has.features12.shaderSubgroupExtendedTypes;
    vulkan12.bufferDeviceAddress = has.features12.bufferDeviceAddress;
  }
  EnabledFeatures(const EnabledFeatures&) = delete;
  EnabledFeatures& operator=(const EnabledFeatures&) = delete;
};

}  // namespace

Device::Device(const Instance& instance, const PhysicalDevice& physical)
    : physical_(physical), name_(physical.name()) {
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = physical.queue_family.value();
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;

  calibrates_ = can_calibrate(instance);
  std::vector<const char*> extensions;
  if (calibrates_) extensions.push_back(VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME);
  const EnabledFeatures features(physical);
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &features.core;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = uint32_t(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check(vkCreateDevice(physical.handle, &info, nullptr, &handle_), "vkCreateDevice");
  vkGetDeviceQueue(handle_, queue.queueFamilyIndex, 0, &queue_);
  load_functions(instance);
  set_name(handle_, VK_OBJECT_TYPE_DEVICE, name_);
  set_name(queue_, VK_OBJECT_TYPE_QUEUE, "compute queue");
}

Device::~Device() {
  vkDestroyDevice(handle_, nullptr);
}

void Device::check(VkResult result, const char* what) const {
  host::check(result, name_, what);
}

bool Device::can_calibrate(const Instance& instance) const {
  if (!physical_.has_extension(VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME)) return false;
  const auto list = reinterpret_cast<PFN_vkGetPhysicalDeviceCalibrateableTimeDomainsEXT>(
      vkGetInstanceProcAddr(instance.handle(), "vkGetPhysicalDeviceCalibrateableTimeDomainsEXT"));
  if (list == nullptr) return false;
  uint32_t count = 0;
  check(list(physical_.handle, &count, nullptr), "vkGetPhysicalDeviceCalibrateableTimeDomainsEXT");
  std::vector<VkTimeDomainEXT> domains(count);
  check(list(physical_.handle, &count, domains.data()), "vkGetPhysicalDeviceCalibrateableTimeDomainsEXT");
  const auto has = [&](VkTimeDomainEXT domain) {
    return std::find(domains.begin(), domains.end(), domain) != domains.end();
  };
  return has(VK_TIME_DOMAIN_DEVICE_EXT) && has(VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT);
}

void Device::load_functions(const Instance& instance) {
  if (instance.has_debug_utils()) {
    set_object_name_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
        vkGetInstanceProcAddr(instance.handle(), "vkSetDebugUtilsObjectNameEXT"));
    begin_label_ = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
        vkGetInstanceProcAddr(instance.handle(), "vkCmdBeginDebugUtilsLabelEXT"));
    end_label_ = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
        vkGetInstanceProcAddr(instance.handle(), "vkCmdEndDebugUtilsLabelEXT"));
  }
  if (calibrates_) {
    get_timestamps_ = reinterpret_cast<PFN_vkGetCalibratedTimestampsEXT>(
        vkGetDeviceProcAddr(handle_, "vkGetCalibratedTimestampsEXT"));
  }
}

void Device::set_object_name(uint64_t object, VkObjectType type, const std::string& object_name) const {
  if (set_object_name_ == nullptr) return;
  VkDebugUtilsObjectNameInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
  info.objectType = type;
  info.objectHandle = object;
  info.pObjectName = object_name.c_str();
  check(set_object_name_(handle_, &info), "vkSetDebugUtilsObjectNameEXT");
}

void Device::begin_label(VkCommandBuffer commands, const char* label) const {
  if (begin_label_ == nullptr) return;
  VkDebugUtilsLabelEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
  info.pLabelName = label;
  begin_label_(commands, &info);
}

void Device::end_label(VkCommandBuffer commands) const {
  if (end_label_ != nullptr) end_label_(commands);
}

bool Device::calibrate(uint64_t& ticks, uint64_t& nanoseconds) const {
  if (get_timestamps_ == nullptr) return false;
  std::array<VkCalibratedTimestampInfoEXT, 2> clocks{};
  clocks[0].sType = clocks[1].sType = VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT;
  clocks[0].timeDomain = VK_TIME_DOMAIN_DEVICE_EXT;
  clocks[1].timeDomain = VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT;
  std::array<uint64_t, 2> values{};
  uint64_t deviation = 0;
  check(get_timestamps_(handle_, 2, clocks.data(), values.data(), &deviation),
        "vkGetCalibratedTimestampsEXT");
  ticks = values[0];
  nanoseconds = values[1];
  return true;
}

}  // namespace lodestone::host
