// SPDX-License-Identifier: MIT
// A back end that keeps book of the buffers made on another.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "lodestone/render/backend.h"

namespace lodestone::test {

class RecordingBackend : public render::Backend {
 public:
  explicit RecordingBackend(std::unique_ptr<render::Backend> device) : device_(std::move(device)) {}

  // Of all buffers of this name, those destroyed since included; 0 where there was none.
  uint64_t bytes(const std::string& name) const {
    const auto found = bytes_.find(name);
    return found == bytes_.end() ? 0 : found->second;
  }

  const render::DeviceInfo& info() const override { return device_->info(); }
  render::BufferId create(const render::BufferDesc& desc) override {
    bytes_[desc.name] += desc.elements * desc.element_bytes;
    return device_->create(desc);
  }
  void destroy(render::BufferId buffer) override { device_->destroy(buffer); }
  void upload(render::BufferId buffer, std::span<const std::byte> bytes, uint64_t offset_bytes) override {
    device_->upload(buffer, bytes, offset_bytes);
  }
  void download(render::BufferId buffer, std::span<std::byte> bytes, uint64_t offset_bytes) override {
    device_->download(buffer, bytes, offset_bytes);
  }
  const render::BufferDesc& desc(render::BufferId buffer) const override { return device_->desc(buffer); }
  void run(const render::Dispatch& dispatch) override { device_->run(dispatch); }
  std::vector<render::PassRecord> finish() override { return device_->finish(); }
  uint64_t allocated_bytes() const override { return device_->allocated_bytes(); }

 private:
  std::unique_ptr<render::Backend> device_;
  std::map<std::string, uint64_t> bytes_;
};

}  // namespace lodestone::test
