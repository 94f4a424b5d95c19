// SPDX-License-Identifier: MIT
// What kernels see as one array: one buffer or, where that would be larger than the device allows, several.
#pragma once

#include <vulkan/vulkan.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "lodestone/host/buffer.h"
#include "lodestone/host/physical_device.h"

namespace lodestone::host {

// How much of an array each variant of a kernel can see (shaders/kernel.glsl). Word and quad arrays that none
// can see whole are cut into segments of 2^segment_shift bytes, and the variant `_split` takes their
// addresses.
struct ArrayLimits {
  // `pairs`: quads are stored as such where the device can do that. `max_bytes`: no buffer is made larger
  // than this, whatever the device can do.
  ArrayLimits(const PhysicalDevice& device, bool texel_buffers, bool pairs, uint64_t max_bytes);

  // The largest array of elements of this size, in bytes, that a texel buffer shows; 0: there are none.
  uint64_t texel_bytes(uint32_t element_bytes) const;
  // The same of any variant that needs no addresses.
  uint64_t whole_bytes(uint32_t element_bytes) const {
    return std::max(storage_bytes, texel_bytes(element_bytes));
  }
  // Of any variant at all.
  uint64_t array_bytes(uint32_t element_bytes) const;
  uint64_t segment_bytes() const { return uint64_t(1) << segment_shift; }

  bool texel_buffers;  // word and quad arrays are texel buffers where those show them whole
  bool pairs;          // but quads that are only written are pairs of 64-bit numbers in storage buffers
  bool has_addresses;  // the device can do more than that
  uint64_t texel_elements;
  uint64_t buffer_bytes;   // of one VkBuffer
  uint64_t storage_bytes;  // of a storage buffer's range
  uint32_t segment_shift;
};

class DeviceArray {
 public:
  static constexpr uint64_t max_segments = 8192;

  // `bytes` > 0, a multiple of 4, at most limits.array_bytes(element_bytes); contents are undefined.
  DeviceArray(const Device& device, MemoryAllocator& memory, const ArrayLimits& limits, uint64_t bytes,
              uint32_t element_bytes, const std::string& name);

  uint64_t bytes() const { return bytes_; }
  bool is_mapped() const;
  bool is_whole() const { return buffers_.size() == 1; }
  DeviceBuffer& whole() { return *buffers_.front(); }
  const std::vector<std::unique_ptr<DeviceBuffer>>& buffers() const { return buffers_; }

  // Where the addresses of the segments belong, and what they are; null where no kernel will ask for them.
  DeviceBuffer* table() const { return table_.get(); }
  std::vector<VkDeviceAddress> segment_addresses() const;

  // Calls `visit(buffer, offset in it, offset from the first byte of all, size)` for each buffer that has a
  // part of these bytes.
  template <class Visit>
  void for_each_piece(uint64_t offset, uint64_t size, const Visit& visit) {
    for (uint64_t done = 0; done < size;) {
      const uint64_t place = offset + done;
      DeviceBuffer& buffer = *buffers_[is_whole() ? 0 : place / segment_bytes_];
      const uint64_t within = is_whole() ? place : place % segment_bytes_;
      const uint64_t piece = std::min(size - done, buffer.bytes() - within);
      visit(buffer, within, done, piece);
      done += piece;
    }
  }

  // Its buffers, for somebody who keeps them until the device has finished.
  std::vector<std::unique_ptr<DeviceBuffer>> release();

 private:
  uint64_t bytes_, segment_bytes_;
  std::vector<std::unique_ptr<DeviceBuffer>>
      buffers_;  // all but the last have segment_bytes_, or there is one
  std::unique_ptr<DeviceBuffer> table_;
};

}  // namespace lodestone::host
