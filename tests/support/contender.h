// SPDX-License-Identifier: MIT
// A scene on a device, ready for the pieces of a frame that benches time.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "lodestone/render/renderer.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {

using PassSeconds = std::map<std::string, double>;  // by the name of the pass, all its dispatches together

class Contender {
 public:
  // `ready` must outlive it. `traversal`: by its name. Throws Error(device), or Error(usage) where the device
  // cannot run that traversal.
  Contender(const ReadyScene& ready, const std::string& device, const render::BackendOptions& options = {},
            const std::string& traversal = "auto");

  render::Renderer& renderer() { return *renderer_; }
  // Waits; what the passes took that have run since the last call: device time where there is one.
  PassSeconds take_passes();
  // Waits; what those of them counted that bear this name (BackendOptions::counters).
  render::Counters take_counters(const std::string& pass);
  const std::string& device() const { return device_; }
  uint64_t allocated_bytes() const { return backend_->allocated_bytes(); }

 private:
  std::string device_;
  std::unique_ptr<render::Backend> backend_;
  std::unique_ptr<render::Renderer> renderer_;
};

}  // namespace lodestone::test
