// SPDX-License-Identifier: MIT
// Descriptor sets from pools that grow with need and are emptied as a whole.
#pragma once

#include <vulkan/vulkan.h>

#include <vector>

#include "lodestone/host/device.h"

namespace lodestone::host {

class DescriptorAllocator {
 public:
  explicit DescriptorAllocator(const Device& device) : device_(device) {}
  ~DescriptorAllocator();
  DescriptorAllocator(const DescriptorAllocator&) = delete;
  DescriptorAllocator& operator=(const DescriptorAllocator&) = delete;

  // A set with at most max_bindings bindings; valid until reset().
  VkDescriptorSet allocate(VkDescriptorSetLayout layout);
  // The device must have finished with all sets.
  void reset();

  static constexpr uint32_t max_bindings = 64;

 private:
  VkDescriptorPool add_pool();

  const Device& device_;
  std::vector<VkDescriptorPool> pools_;
  size_t current_ = 0;  // pools before it are full
};

}  // namespace lodestone::host
