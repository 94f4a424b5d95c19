// SPDX-License-Identifier: MIT
#include "lodestone/host/batch.h"

#include <limits>
#include <utility>

namespace lodestone::host {

Batch::Batch(const Device& device, MemoryAllocator& memory, uint32_t max_passes, bool counting)
    : device_(device),
      max_passes_(max_passes),
      descriptors_(device),
      profiler_(device, memory, max_passes, counting) {
  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool.queueFamilyIndex = device.physical().queue_family.value();
  device.check(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo commands{};
  commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  commands.commandPool = pool_;
  commands.commandBufferCount = 1;
  device.check(vkAllocateCommandBuffers(device.handle(), &commands, &commands_), "vkAllocateCommandBuffers");
  VkFenceCreateInfo fence{};
  fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  device.check(vkCreateFence(device.handle(), &fence, nullptr, &fence_), "vkCreateFence");
  device.set_name(pool_, VK_OBJECT_TYPE_COMMAND_POOL, "batch");
  device.set_name(commands_, VK_OBJECT_TYPE_COMMAND_BUFFER, "batch");
  device.set_name(fence_, VK_OBJECT_TYPE_FENCE, "batch");
}

Batch::~Batch() {
  vkDestroyFence(device_.handle(), fence_, nullptr);
  vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

void Batch::begin(uint64_t serial) {
  serial_ = serial;
  VkCommandBufferBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  device_.check(vkBeginCommandBuffer(commands_, &info), "vkBeginCommandBuffer");
  profiler_.reset(commands_);
}

void Batch::submit() {
  // The host reads mapped buffers and counters once the fence says so.
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
  vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
  device_.check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
  VkSubmitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands_;
  submitted_ = HostClock::now();
  device_.check(vkQueueSubmit(device_.queue(), 1, &info, fence_), "vkQueueSubmit");
}

std::vector<render::PassRecord> Batch::wait(HostClock::time_point origin) {
  constexpr uint64_t forever = std::numeric_limits<uint64_t>::max();
  device_.check(vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, forever), "vkWaitForFences");
  profiler_.collect(records_, origin, submitted_);
  device_.check(vkResetFences(device_.handle(), 1, &fence_), "vkResetFences");
  device_.check(vkResetCommandPool(device_.handle(), pool_, 0), "vkResetCommandPool");
  descriptors_.reset();
  kept_.clear();
  kept_bytes_ = 0;
  return std::exchange(records_, {});
}

uint32_t Batch::add_pass(render::PassRecord record) {
  records_.push_back(std::move(record));
  return uint32_t(records_.size() - 1);
}

void Batch::keep(std::unique_ptr<DeviceBuffer> buffer) {
  kept_bytes_ += buffer->bytes();
  kept_.push_back(std::move(buffer));
}

}  // namespace lodestone::host
