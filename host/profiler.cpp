// SPDX-License-Identifier: MIT
#include "lodestone/host/profiler.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "lodestone/layout/counters.h"

namespace lodestone::host {

namespace {

constexpr uint64_t counter_bytes = layout::counter_words * sizeof(uint32_t);

uint64_t slot_stride(const Device& device) {
  const uint64_t alignment = std::max<uint64_t>(1, device.limits().minStorageBufferOffsetAlignment);
  return (counter_bytes + alignment - 1) / alignment * alignment;
}

render::Counters read_counters(const std::byte* slot) {
  std::array<uint32_t, layout::counter_words> words{};
  std::memcpy(words.data(), slot, counter_bytes);
  const auto value = [&](uint32_t counter) {
    return uint64_t(words[layout::counter_count + counter]) << 32 | words[counter];
  };
  constexpr uint64_t word = sizeof(uint32_t);
  render::Counters counters;
  counters.bytes_read = value(layout::counter_bytes_read) * word;
  counters.bytes_written = value(layout::counter_bytes_written) * word;
  counters.rays = value(layout::counter_rays);
  counters.node_visits = value(layout::counter_node_visits);
  counters.box_tests = value(layout::counter_box_tests);
  counters.triangle_tests = value(layout::counter_triangle_tests);
  counters.lane_steps = value(layout::counter_lane_steps);
  counters.subgroup_steps = value(layout::counter_subgroup_steps);
  return counters;
}

double milliseconds(HostClock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

}  // namespace

PassProfiler::PassProfiler(const Device& device, MemoryAllocator& memory, uint32_t slots, bool counting)
    : device_(device),
      counting_(counting),
      stride_(slot_stride(device)),
      // A slot a pass even where nothing is counted: passes that share one would seem to race for it.
      counters_(device, memory, stride_ * slots, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::readback,
                "counters"),
      slots_(slots) {
  std::memset(counters_.mapped(), 0, counters_.bytes());
  if (!device.has_timestamps()) return;
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * slots;
  device.check(vkCreateQueryPool(device.handle(), &info, nullptr, &queries_), "vkCreateQueryPool");
  device.set_name(queries_, VK_OBJECT_TYPE_QUERY_POOL, "pass timestamps");
}

PassProfiler::~PassProfiler() {
  vkDestroyQueryPool(device_.handle(), queries_, nullptr);
}

void PassProfiler::reset(VkCommandBuffer commands) {
  std::memset(counters_.mapped(), 0, counters_.bytes());
  if (queries_ != VK_NULL_HANDLE) vkCmdResetQueryPool(commands, queries_, 0, 2 * slots_);
}

void PassProfiler::stamp(VkCommandBuffer commands, uint32_t query) const {
  // "Bottom of pipe": when everything before has finished, so that passes which may overlap are not counted
  // twice.
  if (queries_ != VK_NULL_HANDLE) {
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, query);
  }
}

VkDescriptorBufferInfo PassProfiler::counters_of(uint32_t slot) const {
  return {counters_.handle(), slot * stride_, counter_bytes};
}

void PassProfiler::collect(std::span<render::PassRecord> records, HostClock::time_point origin,
                           HostClock::time_point submitted) const {
  if (counting_) {
    for (size_t i = 0; i < records.size(); ++i) {
      records[i].counted = true;
      records[i].counters = read_counters(counters_.mapped() + i * stride_);
    }
  }
  if (records.empty()) return;
  if (queries_ != VK_NULL_HANDLE) {
    collect_times(records, origin, submitted);
    return;
  }
  // Without timestamps a batch is one pass, and the host waits for it.
  for (render::PassRecord& record : records) {
    record.wall_start_ms = milliseconds(submitted - origin);
    record.wall_ms = milliseconds(HostClock::now() - submitted);
  }
}

// Timestamps wrap at the number of bits that the queue says.
double PassProfiler::ticks_between(uint64_t from, uint64_t to) const {
  const uint32_t unused_bits = 64 - device_.physical().timestamp_bits;
  return double(int64_t((to - from) << unused_bits) >> unused_bits);
}

void PassProfiler::collect_times(std::span<render::PassRecord> records, HostClock::time_point origin,
                                 HostClock::time_point submitted) const {
  std::vector<uint64_t> stamps(2 * records.size());
  device_.check(vkGetQueryPoolResults(device_.handle(), queries_, 0, uint32_t(stamps.size()),
                                      stamps.size() * sizeof(uint64_t), stamps.data(), sizeof(uint64_t),
                                      VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                "vkGetQueryPoolResults");
  const double ms_per_tick = double(device_.limits().timestampPeriod) * 1e-6;
  uint64_t anchor_ticks = stamps.front();
  double anchor_ms = milliseconds(submitted - origin);
  uint64_t ticks = 0, nanoseconds = 0;
  if (device_.calibrate(ticks, nanoseconds)) {
    anchor_ticks = ticks;
    anchor_ms = milliseconds(std::chrono::nanoseconds(nanoseconds) - origin.time_since_epoch());
  }
  for (size_t i = 0; i < records.size(); ++i) {
    records[i].wall_start_ms = anchor_ms + ticks_between(anchor_ticks, stamps[2 * i]) * ms_per_tick;
    records[i].wall_ms = ticks_between(stamps[2 * i], stamps[2 * i + 1]) * ms_per_tick;
    if (!records[i].first) records[i].device_ms = records[i].wall_ms;
  }
}

}  // namespace lodestone::host
