// SPDX-License-Identifier: MIT
// How long each pass of a batch took on the device, and what its kernel counted.
#pragma once

#include <vulkan/vulkan.h>

#include <chrono>
#include <memory>
#include <span>

#include "lodestone/host/buffer.h"
#include "lodestone/render/backend.h"

namespace lodestone::host {

using HostClock = std::chrono::steady_clock;

// Slots are used in order, one a pass; a slot holds two timestamps and the words of layout/counters.h.
class PassProfiler {
 public:
  PassProfiler(const Device& device, MemoryAllocator& memory, uint32_t slots, bool counting);
  ~PassProfiler();
  PassProfiler(const PassProfiler&) = delete;
  PassProfiler& operator=(const PassProfiler&) = delete;

  void reset(VkCommandBuffer commands);
  void start(VkCommandBuffer commands, uint32_t slot) const { stamp(commands, 2 * slot); }
  void stop(VkCommandBuffer commands, uint32_t slot) const { stamp(commands, 2 * slot + 1); }
  VkDescriptorBufferInfo counters_of(uint32_t slot) const;

  // Fills in times and counters of passes that have finished; records[i] belongs to slot i. Times of the host
  // count from `origin`. `submitted` anchors the device's clock where it cannot be calibrated.
  void collect(std::span<render::PassRecord> records, HostClock::time_point origin,
               HostClock::time_point submitted) const;

 private:
  void stamp(VkCommandBuffer commands, uint32_t query) const;
  void collect_times(std::span<render::PassRecord> records, HostClock::time_point origin,
                     HostClock::time_point submitted) const;
  double ticks_between(uint64_t from, uint64_t to) const;

  const Device& device_;
  bool counting_;
  uint64_t stride_;  // of a slot's counters, bytes
  DeviceBuffer counters_;
  VkQueryPool queries_ = VK_NULL_HANDLE;  // none where there are no timestamps
  uint32_t slots_;
};

}  // namespace lodestone::host
