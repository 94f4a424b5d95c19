// SPDX-License-Identifier: MIT
#include "lodestone/host/buffer.h"

#include <utility>

namespace lodestone::host {

DeviceBuffer::DeviceBuffer(const Device& device, MemoryAllocator& memory, uint64_t bytes,
                           VkBufferUsageFlags usage, MemoryUse use, std::string name)
    : device_(device), memory_(memory), bytes_(bytes), name_(std::move(name)) {
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = usage;
  device.check(vkCreateBuffer(device.handle(), &info, nullptr, &handle_), "vkCreateBuffer");
  try {
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device.handle(), handle_, &requirements);
    allocation_ = memory.allocate(requirements, use, name_);
    device.check(vkBindBufferMemory(device.handle(), handle_, allocation_.memory, allocation_.offset),
                 "vkBindBufferMemory");
    device.set_name(handle_, VK_OBJECT_TYPE_BUFFER, name_);
  } catch (...) {
    vkDestroyBuffer(device.handle(), handle_, nullptr);
    if (allocation_.memory != VK_NULL_HANDLE) memory.free(allocation_);
    throw;
  }
}

DeviceBuffer::~DeviceBuffer() {
  vkDestroyBufferView(device_.handle(), word_view_, nullptr);
  vkDestroyBufferView(device_.handle(), quad_view_, nullptr);
  vkDestroyBuffer(device_.handle(), handle_, nullptr);
  memory_.free(allocation_);
}

VkDeviceAddress DeviceBuffer::address() const {
  VkBufferDeviceAddressInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
  info.buffer = handle_;
  return vkGetBufferDeviceAddress(device_.handle(), &info);
}

VkBufferView DeviceBuffer::view(VkBufferView& cached, VkFormat format) {
  if (cached != VK_NULL_HANDLE) return cached;
  VkBufferViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
  info.buffer = handle_;
  info.format = format;
  info.range = VK_WHOLE_SIZE;
  device_.check(vkCreateBufferView(device_.handle(), &info, nullptr, &cached), "vkCreateBufferView");
  device_.set_name(cached, VK_OBJECT_TYPE_BUFFER_VIEW, name_);
  return cached;
}

}  // namespace lodestone::host
