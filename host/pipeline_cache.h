// SPDX-License-Identifier: MIT
// What the driver compiled, kept on disk from one run to the next.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lodestone/host/device.h"

namespace lodestone::host {

// $XDG_CACHE_HOME/lodestone, or ~/.cache/lodestone; none where neither variable is an absolute path.
std::optional<std::filesystem::path> default_cache_folder();

// The file of one driver on one device for one set of kernels: its name is made of all three, and so is its
// header. A file that is damaged, cut off or of another key gives nothing.
std::vector<std::byte> pack_pipeline_cache(const std::string& key, std::span<const std::byte> data);
std::vector<std::byte> unpack_pipeline_cache(const std::string& key, std::span<const std::byte> file);

class PipelineCache {
 public:
  // `kernels_digest` stands for the SPIR-V of all kernels. Without a folder the cache lives in memory only.
  PipelineCache(const Device& device, const std::optional<std::filesystem::path>& folder,
                const std::string& kernels_digest);
  ~PipelineCache();  // saves
  PipelineCache(const PipelineCache&) = delete;
  PipelineCache& operator=(const PipelineCache&) = delete;

  VkPipelineCache handle() const { return handle_; }
  // Something was compiled: the file is worth writing again.
  void note_new_pipeline() { changed_ = true; }

 private:
  void save() const;

  const Device& device_;
  std::string key_;
  std::filesystem::path file_;  // empty: none
  bool changed_ = false;
  VkPipelineCache handle_ = VK_NULL_HANDLE;
};

}  // namespace lodestone::host
