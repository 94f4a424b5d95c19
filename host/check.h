// SPDX-License-Identifier: MIT
// Two kinds of failure: what Vulkan answers, which a user may see, and wrong use of this library, which he
// may not.
#pragma once

#include <fmt/format.h>
#include <vulkan/vulkan.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace lodestone::host {

// "VK_ERROR_DEVICE_LOST"
std::string result_name(VkResult result);

// Returns where `result` is no error. Otherwise throws Error(machine) when memory ran out and Error(device)
// for all else; `subject` is the device or the object, `what` the Vulkan command.
void check(VkResult result, const std::string& subject, const char* what);

// Throws std::logic_error: the caller broke the contract of a function.
template <class... Args>
void require(bool condition, fmt::format_string<Args...> format, Args&&... args) {
  if (!condition) throw std::logic_error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace lodestone::host
