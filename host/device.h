// SPDX-License-Identifier: MIT
// The logical device, its one queue, and the names and labels of debuggers.
#pragma once

#include <vulkan/vulkan.h>

#include <string>

#include "lodestone/host/instance.h"
#include "lodestone/host/physical_device.h"

namespace lodestone::host {

class Device {
 public:
  // Both must outlive the device. Enables what kernels may use of what there is.
  Device(const Instance& instance, const PhysicalDevice& physical);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice handle() const { return handle_; }
  VkQueue queue() const { return queue_; }
  const PhysicalDevice& physical() const { return physical_; }
  const VkPhysicalDeviceLimits& limits() const { return physical_.limits(); }
  const std::string& name() const { return name_; }
  bool has_timestamps() const { return physical_.timestamp_bits != 0; }

  // Throws as host::check() does, with the device as the subject.
  void check(VkResult result, const char* what) const;

  // What debuggers and validation messages call an object; nothing without VK_EXT_debug_utils.
  template <class Handle>
  void set_name(Handle object, VkObjectType type, const std::string& object_name) const {
    set_object_name(reinterpret_cast<uint64_t>(object), type, object_name);
  }
  void begin_label(VkCommandBuffer commands, const char* label) const;
  void end_label(VkCommandBuffer commands) const;

  // The same moment on the device's clock (ticks) and std::chrono::steady_clock (nanoseconds); false where
  // the device cannot tell.
  bool calibrate(uint64_t& ticks, uint64_t& nanoseconds) const;

 private:
  void set_object_name(uint64_t object, VkObjectType type, const std::string& object_name) const;
  void load_functions(const Instance& instance);
  bool can_calibrate(const Instance& instance) const;

  const PhysicalDevice& physical_;
  std::string name_;
  VkDevice handle_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  bool calibrates_ = false;
  PFN_vkSetDebugUtilsObjectNameEXT set_object_name_ = nullptr;
  PFN_vkCmdBeginDebugUtilsLabelEXT begin_label_ = nullptr;
  PFN_vkCmdEndDebugUtilsLabelEXT end_label_ = nullptr;
  PFN_vkGetCalibratedTimestampsEXT get_timestamps_ = nullptr;
};

}  // namespace lodestone::host
