// SPDX-License-Identifier: MIT
// Device memory in blocks: a driver allows few allocations, a renderer wants many buffers.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "lodestone/host/device.h"
#include "lodestone/host/memory_space.h"

namespace lodestone::host {

enum class MemoryUse {
  device,    // what kernels work on; mapped as well where host and device share their memory
  upload,    // written by the host, read once by the device
  readback,  // written by the device, read by the host
};

struct Allocation {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize offset = 0, size = 0;
  std::byte* mapped = nullptr;  // of this allocation, coherent; null: not visible to the host
  uint32_t block = 0;           // for free()
};

class MemoryAllocator {
 public:
  // `map_device_memory`: let MemoryUse::device be mapped where that costs nothing.
  MemoryAllocator(const Device& device, bool map_device_memory);
  ~MemoryAllocator();
  MemoryAllocator(const MemoryAllocator&) = delete;
  MemoryAllocator& operator=(const MemoryAllocator&) = delete;

  // `owner` is the name that an Error(machine) tells when there is no memory left.
  Allocation allocate(const VkMemoryRequirements& requirements, MemoryUse use, const std::string& owner);
  void free(const Allocation& allocation);

  uint64_t allocated_bytes() const { return allocated_bytes_; }  // by callers, not by blocks
  size_t block_count() const;

 private:
  struct Block {
    VkDeviceMemory memory;
    uint32_t type;
    std::byte* mapped;
    MemorySpace space;
  };

  uint32_t find_type(uint32_t allowed, MemoryUse use) const;
  uint32_t add_block(uint64_t size, uint32_t type, const std::string& owner);
  Allocation take(uint32_t block, const VkMemoryRequirements& requirements);

  const Device& device_;
  bool map_device_memory_;
  uint64_t allocated_bytes_ = 0;
  std::vector<std::unique_ptr<Block>> blocks_;  // null: given back
};

}  // namespace lodestone::host
