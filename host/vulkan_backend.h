// SPDX-License-Identifier: MIT
// render::Backend on Vulkan compute.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "lodestone/host/device_list.h"
#include "lodestone/host/pipeline_cache.h"
#include "lodestone/kernels/kernels.h"
#include "lodestone/render/backend.h"

namespace lodestone::host {

// What tests and live reload choose otherwise.
struct HostOptions {
  TexelBuffers texel_buffers = TexelBuffers::automatic;
  bool map_device_memory =
      true;  // false: copy through staging buffers even where host and device share memory
  uint64_t max_buffer_bytes = std::numeric_limits<uint64_t>::max();  // arrays larger than this are split, as
                                                                     // they are by the device's own limit
  uint32_t passes_per_batch =
      64;  // a batch of commands is submitted when it has so many passes, or somebody waits
  std::span<const kernels::Kernel> kernels =
      kernels::all_kernels();  // ordered by name; must outlive the back end
  std::optional<std::filesystem::path> cache_folder =
      default_cache_folder();  // of compiled pipelines; none: not kept
};

// `selector`: see select_device(). Throws Error(device) where there is no such device or, with
// options.validate, no validation layer. Messages of the layers are thrown by finish(); those of destruction
// are kept for take_late_messages().
std::unique_ptr<render::Backend> make_backend(const std::string& selector,
                                              const render::BackendOptions& options,
                                              const HostOptions& host_options = {});

}  // namespace lodestone::host
