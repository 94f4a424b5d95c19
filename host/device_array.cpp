// SPDX-License-Identifier: MIT
#include "lodestone/host/device_array.h"

#include <fmt/format.h>

#include <bit>
#include <utility>

#include "lodestone/host/check.h"

namespace lodestone::host {

namespace {

// A table of addresses is written by one vkCmdUpdateBuffer.
static_assert(DeviceArray::max_segments * sizeof(VkDeviceAddress) <= 65536);
constexpr uint64_t largest_segment = uint64_t(1) << 31;
constexpr uint64_t largest_count = uint64_t(1) << 32;  // kernels index by 32 bits

bool is_word_or_quad(uint32_t element_bytes) {
  return element_bytes == 4 || element_bytes == 16;
}

}  // namespace

ArrayLimits::ArrayLimits(const PhysicalDevice& device, bool uses_texel_buffers, bool uses_pairs,
                         uint64_t max_bytes)
    : texel_buffers(uses_texel_buffers),
      pairs(uses_texel_buffers && uses_pairs && device.features.shaderInt64 == VK_TRUE),
      has_addresses(device.features12.bufferDeviceAddress == VK_TRUE),
      texel_elements(device.limits().maxTexelBufferElements),
      buffer_bytes(std::min(device.max_buffer_size, max_bytes)),
      storage_bytes(std::min<uint64_t>(device.limits().maxStorageBufferRange, buffer_bytes)),
      segment_shift(uint32_t(std::bit_width(std::min(buffer_bytes, largest_segment))) - 1) {
  require(buffer_bytes >= 16, "a buffer of {} bytes has no room for a quad", buffer_bytes);
}

uint64_t ArrayLimits::texel_bytes(uint32_t element_bytes) const {
  if (!texel_buffers || !is_word_or_quad(element_bytes)) return 0;
  return std::min(texel_elements * element_bytes, buffer_bytes);
}

uint64_t ArrayLimits::array_bytes(uint32_t element_bytes) const {
  if (!has_addresses || !is_word_or_quad(element_bytes)) return whole_bytes(element_bytes);
  return std::min(DeviceArray::max_segments * segment_bytes(), largest_count * element_bytes);
}

DeviceArray::DeviceArray(const Device& device, MemoryAllocator& memory, const ArrayLimits& limits,
                         uint64_t bytes, uint32_t element_bytes, const std::string& name)
    : bytes_(bytes), segment_bytes_(limits.segment_bytes()) {
  VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  if (limits.texel_buffers) usage |= VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
  // A kernel that gets one array by addresses gets all that way which a storage buffer cannot show.
  const bool addressed =
      bytes > limits.storage_bytes && limits.has_addresses && is_word_or_quad(element_bytes);
  if (addressed) usage |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  const bool whole = bytes <= limits.whole_bytes(element_bytes);
  const uint64_t segments = (bytes - 1) / segment_bytes_ + 1;
  const uint64_t count = whole ? 1 : segments;
  for (uint64_t i = 0; i < count; ++i) {
    const uint64_t size = whole ? bytes : std::min(segment_bytes_, bytes - i * segment_bytes_);
    const std::string label = count == 1 ? name : fmt::format("{} {} of {}", name, i + 1, count);
    buffers_.push_back(std::make_unique<DeviceBuffer>(device, memory, size, usage, MemoryUse::device, label));
  }
  if (!addressed) return;
  table_ =
      std::make_unique<DeviceBuffer>(device, memory, segments * sizeof(VkDeviceAddress),
                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                     MemoryUse::device, "addresses of " + name);
}

bool DeviceArray::is_mapped() const {
  return std::all_of(buffers_.begin(), buffers_.end(),
                     [](const auto& buffer) { return buffer->mapped() != nullptr; });
}

std::vector<VkDeviceAddress> DeviceArray::segment_addresses() const {
  std::vector<VkDeviceAddress> addresses;
  for (const auto& buffer : buffers_) {
    const VkDeviceAddress first = buffer->address();
    for (uint64_t offset = 0; offset < buffer->bytes(); offset += segment_bytes_)
      addresses.push_back(first + offset);
  }
  return addresses;
}

std::vector<std::unique_ptr<DeviceBuffer>> DeviceArray::release() {
  if (table_) buffers_.push_back(std::move(table_));
  return std::exchange(buffers_, {});
}

}  // namespace lodestone::host
