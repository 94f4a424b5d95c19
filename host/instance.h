// SPDX-License-Identifier: MIT
// The Vulkan instance, with the validation layers where they are asked for.
#pragma once

#include <vulkan/vulkan.h>

#include <vector>

#include "lodestone/host/validation.h"

namespace lodestone::host {

class Instance {
 public:
  // Throws Error(device) where there is no driver at all or the layers are missing.
  explicit Instance(bool validate);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return handle_; }
  bool has_debug_utils() const { return debug_utils_; }
  bool validates() const { return validate_; }
  MessageLog& messages() { return messages_; }

  // Hardware first, software last, otherwise in the loader's order.
  std::vector<VkPhysicalDevice> physical_devices() const;

 private:
  bool validate_ = false;
  bool debug_utils_ = false;
  MessageLog messages_;
  VkInstance handle_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

// Messages that came while a device or an instance was being destroyed, when nobody could be told any more. A
// program that promises "any message is an error" asks for them at its end. Leaves the list empty.
std::vector<std::string> take_late_messages();

}  // namespace lodestone::host
