// SPDX-License-Identifier: MIT
#include "lodestone/host/memory.h"

#include <algorithm>

#include "lodestone/base/error.h"
#include "lodestone/base/memory.h"
#include "lodestone/host/check.h"

namespace lodestone::host {

namespace {

constexpr uint64_t block_bytes = uint64_t(32) << 20;
constexpr VkMemoryPropertyFlags host_flags =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

}  // namespace

MemoryAllocator::MemoryAllocator(const Device& device, bool map_device_memory)
    : device_(device), map_device_memory_(map_device_memory && device.physical().shares_memory()) {}

MemoryAllocator::~MemoryAllocator() {
  for (const auto& block : blocks_) {
    if (block) vkFreeMemory(device_.handle(), block->memory, nullptr);
  }
}

size_t MemoryAllocator::block_count() const {
  return size_t(
      std::count_if(blocks_.begin(), blocks_.end(), [](const auto& block) { return block != nullptr; }));
}

// The first allowed type with the flags that the use needs, and of those one with the flags that it likes.
uint32_t MemoryAllocator::find_type(uint32_t allowed, MemoryUse use) const {
  VkMemoryPropertyFlags needs = 0, likes = 0;
  switch (use) {
    case MemoryUse::device:
      likes = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
      if (map_device_memory_) likes |= host_flags | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
      break;
    case MemoryUse::upload:
      needs = host_flags;
      break;
    case MemoryUse::readback:
      needs = host_flags;
      likes = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
      break;
  }
  const VkPhysicalDeviceMemoryProperties& memory = device_.physical().memory;
  uint32_t best = memory.memoryTypeCount;
  int best_score = -1;
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    const VkMemoryPropertyFlags flags = memory.memoryTypes[i].propertyFlags;
    if ((allowed >> i & 1u) == 0 || (flags & needs) != needs) continue;
    const int score = __builtin_popcount(flags & likes);
    if (score > best_score) {
      best = i;
      best_score = score;
    }
  }
  if (best_score < 0) fail(ExitCode::device, device_.name(), "it has no memory that the host can see");
  return best;
}

uint32_t MemoryAllocator::add_block(uint64_t size, uint32_t type, const std::string& owner) {
  if (device_.physical().shares_memory()) require_memory(size, "buffer " + owner);
  // Any buffer in the block may be one that kernels reach by its address.
  VkMemoryAllocateFlagsInfo flags{};
  flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  if (device_.physical().features12.bufferDeviceAddress == VK_TRUE) info.pNext = &flags;
  info.allocationSize = size;
  info.memoryTypeIndex = type;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  const VkResult result = vkAllocateMemory(device_.handle(), &info, nullptr, &memory);
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
    fail(ExitCode::machine, device_.name(),
         "{} more bytes for {} are not to be had, beside {} in use: use a lower resolution or another "
         "--device",
         size, owner, allocated_bytes_);
  }
  device_.check(result, "vkAllocateMemory");
  void* mapped = nullptr;
  if ((device_.physical().memory.memoryTypes[type].propertyFlags & host_flags) == host_flags) {
    const VkResult map_result = vkMapMemory(device_.handle(), memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (map_result != VK_SUCCESS) vkFreeMemory(device_.handle(), memory, nullptr);
    device_.check(map_result, "vkMapMemory");
  }
  const auto hole = std::find(blocks_.begin(), blocks_.end(), nullptr);
  const auto index = uint32_t(hole - blocks_.begin());
  auto block =
      std::make_unique<Block>(Block{memory, type, static_cast<std::byte*>(mapped), MemorySpace(size)});
  if (hole == blocks_.end()) {
    blocks_.push_back(std::move(block));
  } else {
    *hole = std::move(block);
  }
  device_.set_name(memory, VK_OBJECT_TYPE_DEVICE_MEMORY, fmt::format("memory block {}", index));
  return index;
}

Allocation MemoryAllocator::allocate(const VkMemoryRequirements& requirements, MemoryUse use,
                                     const std::string& owner) {
  const uint32_t type = find_type(requirements.memoryTypeBits, use);
  for (uint32_t i = 0; i < blocks_.size(); ++i) {
    if (!blocks_[i] || blocks_[i]->type != type) continue;
    const Allocation allocation = take(i, requirements);
    if (allocation.memory != VK_NULL_HANDLE) return allocation;
  }
  // What would fill half a block gets one of its own.
  const uint64_t size = requirements.size > block_bytes / 2 ? requirements.size : block_bytes;
  return take(add_block(size, type, owner), requirements);
}

Allocation MemoryAllocator::take(uint32_t index, const VkMemoryRequirements& requirements) {
  Block& block = *blocks_[index];
  const std::optional<uint64_t> offset = block.space.take(requirements.size, requirements.alignment);
  if (!offset) return {};
  allocated_bytes_ += requirements.size;
  return {block.memory, *offset, requirements.size,
          block.mapped == nullptr ? nullptr : block.mapped + *offset, index};
}

void MemoryAllocator::free(const Allocation& allocation) {
  Block& block = *blocks_.at(allocation.block);
  block.space.give_back(allocation.offset, allocation.size);
  allocated_bytes_ -= allocation.size;
  if (!block.space.is_empty()) return;
  // Keep one empty block of ordinary size for the next buffer.
  const bool keeps =
      block.space.size() == block_bytes &&
      std::none_of(blocks_.begin(), blocks_.end(), [&](const auto& other) {
        return other && other.get() != &block && other->type == block.type && other->space.is_empty();
      });
  if (keeps) return;
  vkFreeMemory(device_.handle(), block.memory, nullptr);
  blocks_[allocation.block].reset();
}

}  // namespace lodestone::host
