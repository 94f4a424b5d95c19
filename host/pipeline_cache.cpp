// SPDX-License-Identifier: MIT
#include "lodestone/host/pipeline_cache.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <exception>

#include "lodestone/base/file.h"
#include "lodestone/base/hash.h"
#include "lodestone/base/log.h"

namespace lodestone::host {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t largest_file = uint64_t(256) << 20;
constexpr std::string_view magic = "lodestone pipelines 1\n";

std::string digest(std::span<const std::byte> bytes) {
  ContentHash hash;
  hash.add(bytes);
  return hash.hex();
}

// Drivers should judge foreign data themselves; not all do.
bool is_for_device(std::span<const std::byte> data, const VkPhysicalDeviceProperties& device) {
  VkPipelineCacheHeaderVersionOne header{};
  if (data.size() < sizeof(header)) return false;
  std::memcpy(&header, data.data(), sizeof(header));
  return header.headerSize >= sizeof(header) && header.headerSize <= data.size() &&
         header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == device.vendorID &&
         header.deviceID == device.deviceID &&
         std::memcmp(header.pipelineCacheUUID, device.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

std::string make_key(const PhysicalDevice& device, const std::string& kernels_digest) {
  ContentHash hash;
  hash.add(std::as_bytes(std::span(device.properties11.deviceUUID)));
  hash.add(std::as_bytes(std::span(device.properties11.driverUUID)));
  hash.add(std::as_bytes(std::span(device.properties.pipelineCacheUUID)));
  hash.add_value(device.properties.driverVersion);
  hash.add(kernels_digest);
  return hash.hex();
}

}  // namespace

std::optional<fs::path> default_cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return fs::path(value == nullptr ? "" : value);
  };
  if (const fs::path cache = variable("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "lodestone";
  if (const fs::path home = variable("HOME"); home.is_absolute()) return home / ".cache/lodestone";
  return std::nullopt;
}

std::vector<std::byte> pack_pipeline_cache(const std::string& key, std::span<const std::byte> data) {
  const std::string header = std::string(magic) + key + "\n" + digest(data) + "\n";
  std::vector<std::byte> file(header.size() + data.size());
  std::memcpy(file.data(), header.data(), header.size());
  if (!data.empty()) std::memcpy(file.data() + header.size(), data.data(), data.size());
  return file;
}

std::vector<std::byte> unpack_pipeline_cache(const std::string& key, std::span<const std::byte> file) {
  constexpr size_t digest_length = 32;
  const std::string start = std::string(magic) + key + "\n";
  const size_t header_length = start.size() + digest_length + 1;
  if (file.size() < header_length || std::memcmp(file.data(), start.data(), start.size()) != 0) return {};
  const auto data = file.subspan(header_length);
  const std::string expected = digest(data) + "\n";
  if (std::memcmp(file.data() + start.size(), expected.data(), expected.size()) != 0) return {};
  return {data.begin(), data.end()};
}

PipelineCache::PipelineCache(const Device& device, const std::optional<fs::path>& folder,
                             const std::string& kernels_digest)
    : device_(device), key_(make_key(device.physical(), kernels_digest)) {
  std::vector<std::byte> data;
  if (folder) {
    file_ = *folder / fmt::format("pipelines-{}.bin", key_);
    try {
      if (fs::exists(file_)) data = unpack_pipeline_cache(key_, read_file(file_, largest_file));
      if (!data.empty() && !is_for_device(data, device.physical().properties)) data.clear();
    } catch (const std::exception& error) {
      log::note(fmt::format("the pipeline cache is not used: {}", error.what()));
    }
  }
  VkPipelineCacheCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
  info.initialDataSize = data.size();
  info.pInitialData = data.data();
  device.check(vkCreatePipelineCache(device.handle(), &info, nullptr, &handle_), "vkCreatePipelineCache");
  device.set_name(handle_, VK_OBJECT_TYPE_PIPELINE_CACHE, "pipeline cache");
}

PipelineCache::~PipelineCache() {
  try {
    if (changed_ && !file_.empty()) save();
  } catch (const std::exception& error) {
    // A cache that cannot be written costs time, never the picture.
    log::note(fmt::format("the pipeline cache is not saved: {}", error.what()));
  }
  vkDestroyPipelineCache(device_.handle(), handle_, nullptr);
}

void PipelineCache::save() const {
  size_t size = 0;
  device_.check(vkGetPipelineCacheData(device_.handle(), handle_, &size, nullptr), "vkGetPipelineCacheData");
  std::vector<std::byte> data(size);
  device_.check(vkGetPipelineCacheData(device_.handle(), handle_, &size, data.data()),
                "vkGetPipelineCacheData");
  data.resize(size);
  write_file(file_, pack_pipeline_cache(key_, data));
}

}  // namespace lodestone::host
