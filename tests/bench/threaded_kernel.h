// SPDX-License-Identifier: MIT
// A ThreadedBvh through the product's own kernel `trace_threaded`, the paper's traversal: that follows
// whatever links it is given, so both hierarchies can be compared on every device with the same code.
#pragma once

#include <memory>
#include <string>

#include "lodestone/render/tracing.h"
#include "threaded_bvh.h"

namespace lodestone::test {

class ThreadedKernel {
 public:
  // Throws Error(device).
  ThreadedKernel(const ThreadedBvh& bvh, const std::string& device,
                 const render::BackendOptions& options = {});

  void load_rays(const Rays& rays);
  void trace();  // waits
  std::vector<TriangleHit> hits();
  render::Counters take_counters();  // since the last call, where BackendOptions::counters is set

 private:
  std::unique_ptr<render::Backend> backend_;
  render::Buffer geometry_, nodes_lo_, nodes_hi_, links_, objects_, pending_;
  render::RayBuffers rays_;
  uint32_t ray_count_ = 0;
};

}  // namespace lodestone::test
