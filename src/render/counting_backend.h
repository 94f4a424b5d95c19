// SPDX-License-Identifier: MIT
// How much memory something would take on a device: a back end that makes no buffers and runs nothing.
#pragma once

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "lodestone/render/backend.h"

namespace lodestone::render {

class CountingBackend : public Backend {
 public:
  // `info`: of the device in question.
  explicit CountingBackend(DeviceInfo info) : info_(std::move(info)) {}

  const DeviceInfo& info() const override { return info_; }
  BufferId create(const BufferDesc& desc) override {
    buffers_[next_] = desc;
    allocated_ += bytes(desc);
    return next_++;
  }
  void destroy(BufferId buffer) override {
    allocated_ -= bytes(buffers_.at(buffer));
    buffers_.erase(buffer);
  }
  void upload(BufferId, std::span<const std::byte>, uint64_t) override {}
  void download(BufferId, std::span<std::byte> to, uint64_t) override {
    std::fill(to.begin(), to.end(), std::byte{0});
  }
  const BufferDesc& desc(BufferId buffer) const override { return buffers_.at(buffer); }
  void run(const Dispatch&) override {}
  std::vector<PassRecord> finish() override { return {}; }
  uint64_t allocated_bytes() const override { return allocated_; }

 private:
  // Devices round a little up.
  static uint64_t bytes(const BufferDesc& desc) { return desc.elements * desc.element_bytes + 256; }

  DeviceInfo info_;
  std::unordered_map<BufferId, BufferDesc> buffers_;
  BufferId next_ = 1;
  uint64_t allocated_ = 0;
};

}  // namespace lodestone::render
