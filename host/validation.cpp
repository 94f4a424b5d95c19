// SPDX-License-Identifier: MIT
#include "lodestone/host/validation.h"

#include <string_view>
#include <utility>

#include "lodestone/base/error.h"

namespace lodestone::host {

VkDebugUtilsMessengerCreateInfoEXT MessageLog::messenger_info() {
  VkDebugUtilsMessengerCreateInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                     VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                     VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = receive;
  info.pUserData = this;
  return info;
}

std::vector<std::string> MessageLog::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(messages_, {});
}

VkBool32 MessageLog::receive(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT types,
                             const VkDebugUtilsMessengerCallbackDataEXT* data, void* log) {
  const bool of_loader = types == VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT &&
                         data->pMessageIdName != nullptr &&
                         std::string_view(data->pMessageIdName) == "Loader Message";
  if (!of_loader) {
    auto* self = static_cast<MessageLog*>(log);
    const std::lock_guard lock(self->mutex_);
    self->messages_.emplace_back(data->pMessage == nullptr ? "(no text)" : data->pMessage);
  }
  return VK_FALSE;
}

void fail_on_messages(const std::string& device, const std::vector<std::string>& messages) {
  if (messages.empty()) return;
  fail(ExitCode::device, device, "{} validation message{}; the first: {}", messages.size(),
       messages.size() == 1 ? "" : "s", messages.front());
}

}  // namespace lodestone::host
