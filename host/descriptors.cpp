// SPDX-License-Identifier: MIT
#include "lodestone/host/descriptors.h"

#include <array>

namespace lodestone::host {

namespace {
constexpr uint32_t sets_of_pool = 64;
constexpr uint32_t descriptors_of_set = 16;  // on average
static_assert(sets_of_pool * descriptors_of_set >= DescriptorAllocator::max_bindings);
}  // namespace

DescriptorAllocator::~DescriptorAllocator() {
  for (VkDescriptorPool pool : pools_) vkDestroyDescriptorPool(device_.handle(), pool, nullptr);
}

VkDescriptorPool DescriptorAllocator::add_pool() {
  const uint32_t count = sets_of_pool * descriptors_of_set;
  const std::array<VkDescriptorPoolSize, 2> sizes{
      {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count}, {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, count}}};
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = sets_of_pool;
  info.poolSizeCount = uint32_t(sizes.size());
  info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  device_.check(vkCreateDescriptorPool(device_.handle(), &info, nullptr, &pool), "vkCreateDescriptorPool");
  pools_.push_back(pool);
  device_.set_name(pool, VK_OBJECT_TYPE_DESCRIPTOR_POOL, "descriptor pool");
  return pool;
}

VkDescriptorSet DescriptorAllocator::allocate(VkDescriptorSetLayout layout) {
  for (;;) {
    const bool is_new = current_ == pools_.size();
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = is_new ? add_pool() : pools_[current_];
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult result = vkAllocateDescriptorSets(device_.handle(), &info, &set);
    const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
    if (!full || is_new) {
      device_.check(result, "vkAllocateDescriptorSets");
      return set;
    }
    ++current_;
  }
}

void DescriptorAllocator::reset() {
  for (VkDescriptorPool pool : pools_) {
    device_.check(vkResetDescriptorPool(device_.handle(), pool, 0), "vkResetDescriptorPool");
  }
  current_ = 0;
}

}  // namespace lodestone::host
