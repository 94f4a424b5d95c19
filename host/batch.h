// SPDX-License-Identifier: MIT
// Commands that are submitted together, and everything that must live until the device has finished with
// them.
#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <vector>

#include "lodestone/host/buffer.h"
#include "lodestone/host/descriptors.h"
#include "lodestone/host/profiler.h"
#include "lodestone/render/backend.h"

namespace lodestone::host {

class Batch {
 public:
  Batch(const Device& device, MemoryAllocator& memory, uint32_t max_passes, bool counting);
  ~Batch();
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  // begin(), commands, submit(), wait(), and again.
  void begin(uint64_t serial);
  void submit();
  // Waits for the device and returns the records of the passes.
  std::vector<render::PassRecord> wait(HostClock::time_point origin);

  uint64_t serial() const { return serial_; }
  VkCommandBuffer commands() const { return commands_; }
  DescriptorAllocator& descriptors() { return descriptors_; }
  PassProfiler& profiler() { return profiler_; }

  // The slot of a new pass in the profiler.
  uint32_t add_pass(render::PassRecord record);
  bool is_full() const { return records_.size() == max_passes_; }

  // Destroys a buffer once the device has finished.
  void keep(std::unique_ptr<DeviceBuffer> buffer);
  uint64_t kept_bytes() const { return kept_bytes_; }

 private:
  const Device& device_;
  uint32_t max_passes_;
  uint64_t serial_ = 0;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
  DescriptorAllocator descriptors_;
  PassProfiler profiler_;
  std::vector<render::PassRecord> records_;
  std::vector<std::unique_ptr<DeviceBuffer>> kept_;
  uint64_t kept_bytes_ = 0;
  HostClock::time_point submitted_;
};

}  // namespace lodestone::host
