// SPDX-License-Identifier: MIT
// What the Vulkan validation layers have to say.
#pragma once

#include <vulkan/vulkan.h>

#include <mutex>
#include <string>
#include <vector>

namespace lodestone::host {

inline constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

// Collects every message of warning or error severity but those of the loader about drivers and layers that
// it could not load, which say nothing about this program. Safe from any thread.
class MessageLog {
 public:
  // For vkCreateDebugUtilsMessengerEXT, and as pNext of VkInstanceCreateInfo. The log must outlive the
  // messenger.
  VkDebugUtilsMessengerCreateInfoEXT messenger_info();

  std::vector<std::string> take();  // leaves the log empty

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL receive(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                VkDebugUtilsMessageTypeFlagsEXT types,
                                                const VkDebugUtilsMessengerCallbackDataEXT* data, void* log);

  std::mutex mutex_;
  std::vector<std::string> messages_;
};

// Throws Error(device) with the first of the messages and their number; does nothing where there are none.
void fail_on_messages(const std::string& device, const std::vector<std::string>& messages);

}  // namespace lodestone::host
