// SPDX-License-Identifier: MIT
// One VkBuffer with its memory and, where kernels see it so, its texel views.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <string>

#include "lodestone/host/memory.h"

namespace lodestone::host {

class DeviceBuffer {
 public:
  // `bytes` > 0. Contents are undefined.
  DeviceBuffer(const Device& device, MemoryAllocator& memory, uint64_t bytes, VkBufferUsageFlags usage,
               MemoryUse use, std::string name);
  ~DeviceBuffer();
  DeviceBuffer(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(const DeviceBuffer&) = delete;

  VkBuffer handle() const { return handle_; }
  uint64_t bytes() const { return bytes_; }
  std::byte* mapped() const { return allocation_.mapped; }  // null: not visible to the host
  const std::string& name() const { return name_; }
  // Where kernels find it; made with VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT.
  VkDeviceAddress address() const;

  // The whole buffer as R32_UINT or R32G32B32A32_UINT; made at the first call.
  VkBufferView word_view() { return view(word_view_, VK_FORMAT_R32_UINT); }
  VkBufferView quad_view() { return view(quad_view_, VK_FORMAT_R32G32B32A32_UINT); }

 private:
  VkBufferView view(VkBufferView& cached, VkFormat format);

  const Device& device_;
  MemoryAllocator& memory_;
  uint64_t bytes_;
  std::string name_;
  VkBuffer handle_ = VK_NULL_HANDLE;
  Allocation allocation_;
  VkBufferView word_view_ = VK_NULL_HANDLE, quad_view_ = VK_NULL_HANDLE;
};

}  // namespace lodestone::host
