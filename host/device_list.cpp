// SPDX-License-Identifier: MIT
#include "lodestone/host/device_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/host/device_array.h"
#include "lodestone/host/driver_files.h"

namespace lodestone::host {

namespace {

// Below this, texel buffers are smaller than storage buffers on devices with real storage buffers.
constexpr uint64_t texel_elements_wanted = uint64_t(1) << 27;

std::string api_version(uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

std::string mebibytes(uint64_t bytes) {
  if (bytes >> 20 >= uint64_t(1) << 32) return "any size";
  return bytes % (1 << 20) == 0 ? fmt::format("{} MiB", bytes >> 20) : fmt::format("{} bytes", bytes);
}

bool has_subgroup_shuffle(const PhysicalDevice& device) {
  return (device.properties11.subgroupSupportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT) != 0 &&
         (device.properties11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
}

std::vector<std::string> list_lacks(const PhysicalDevice& device) {
  std::vector<std::string> lacks = missing_requirements(device);
  const auto need = [&](bool has, const char* what) {
    if (!has) lacks.emplace_back(what);
  };
  const VkPhysicalDeviceFeatures& core = device.features;
  need(core.shaderInt64, "64-bit integers in kernels");
  need(core.shaderInt16, "16-bit integers in kernels");
  need(device.features12.shaderInt8, "8-bit integers in kernels");
  need(core.shaderFloat64, "64-bit floats in kernels");
  need(device.features12.shaderFloat16, "16-bit floats in kernels");
  need(device.features12.shaderBufferInt64Atomics, "64-bit atomics");
  need(device.features12.bufferDeviceAddress, "buffer device addresses");
  need(device.features12.descriptorIndexing, "descriptor indexing");
  need(core.pipelineStatisticsQuery, "pipeline statistics queries");
  need(has_subgroup_shuffle(device), "subgroup shuffles");
  need(device.texel_formats && device.limits().maxTexelBufferElements >= texel_elements_wanted,
       "texel buffers of 2^27 elements");
  need(device.timestamp_bits != 0, "timestamps");
  need(device.has_extension(VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME), "calibrated timestamps");
  need(device.has_extension(VK_KHR_RAY_QUERY_EXTENSION_NAME), "ray queries (this program needs none)");
  need(!device.cuts_loops(), "loops of more than 65,535 iterations (it stops them without a word)");
  return lacks;
}

std::vector<DeviceProperty> list_properties(const PhysicalDevice& device, bool texel_buffers) {
  const VkPhysicalDeviceLimits& limits = device.limits();
  uint64_t local = 0;
  for (uint32_t i = 0; i < device.memory.memoryHeapCount; ++i) {
    if ((device.memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) {
      local += device.memory.memoryHeaps[i].size;
    }
  }
  return {
      {"subgroup size", fmt::format("{}", device.properties11.subgroupSize)},
      {"workgroup invocations", fmt::format("{}", limits.maxComputeWorkGroupInvocations)},
      {"workgroups", fmt::format("{}", limits.maxComputeWorkGroupCount[0])},
      {"shared memory", fmt::format("{} KiB", limits.maxComputeSharedMemorySize >> 10)},
      {"device memory", mebibytes(local)},
      {"memory shared with the host", device.shares_memory() ? "yes" : "no"},
      {"largest allocation", mebibytes(device.properties11.maxMemoryAllocationSize)},
      {"largest storage buffer range", mebibytes(limits.maxStorageBufferRange)},
      {"texel buffer elements", fmt::format("{}", limits.maxTexelBufferElements)},
      {"words and quads as texel buffers", texel_buffers ? "yes" : "no"},
      {"storage buffers of a kernel", fmt::format("{}", limits.maxPerStageDescriptorStorageBuffers)},
      {"texel buffers of a kernel", fmt::format("{}", limits.maxPerStageDescriptorStorageImages)},
      {"push constants", fmt::format("{} bytes", limits.maxPushConstantsSize)},
      {"timestamp period",
       device.timestamp_bits == 0 ? "none" : fmt::format("{} ns", limits.timestampPeriod)},
  };
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

std::string list_names(const std::vector<DeviceDetails>& devices) {
  std::vector<std::string> lines;
  for (const DeviceDetails& device : devices)
    lines.push_back(fmt::format("{}: {}", device.index, device.name));
  return fmt::format("{}", fmt::join(lines, ", "));
}

}  // namespace

bool uses_texel_buffers(const PhysicalDevice& device, TexelBuffers choice) {
  if (choice == TexelBuffers::never) return false;
  if (choice != TexelBuffers::automatic) {
    if (!device.texel_formats) {
      fail(ExitCode::device, device.name(), "R32_UINT or R32G32B32A32_UINT cannot be storage texel buffers");
    }
    return true;
  }
  return device.texel_formats && device.limits().maxTexelBufferElements >= texel_elements_wanted;
}

DeviceDetails describe_device(const PhysicalDevice& device, uint32_t index, bool texel_buffers) {
  DeviceDetails details;
  details.kind = "gpu";
  details.name = device.name();
  const std::string version = device.properties12.driverInfo;
  const std::string driver = device.properties12.driverName;
  details.driver = driver.empty() ? fmt::format("{:#x}", device.properties.driverVersion)
                                  : (version.empty() ? driver : driver + " " + version);
  details.api = api_version(device.properties.apiVersion);
  details.index = index;
  details.subgroup_size = std::max(1u, device.properties11.subgroupSize);
  details.cuts_loops = device.cuts_loops();
  details.lacks = list_lacks(device);
  details.unusable = missing_requirements(device);
  if (details.unusable.empty()) {
    const ArrayLimits limits(device, texel_buffers, true, std::numeric_limits<uint64_t>::max());
    details.max_buffer_bytes = std::min(limits.whole_bytes(4), limits.whole_bytes(16));
  }
  details.properties = list_properties(device, texel_buffers);
  return details;
}

std::vector<DeviceDetails> list_devices() {
  std::vector<DeviceDetails> devices;
  try {
    const Instance instance(false);
    for (VkPhysicalDevice handle : instance.physical_devices()) {
      const PhysicalDevice device = query_physical_device(handle);
      const bool texel = uses_texel_buffers(device, TexelBuffers::automatic);
      devices.push_back(describe_device(device, uint32_t(devices.size()), texel));
    }
  } catch (const Error& error) {
    if (error.code() != ExitCode::device) throw;  // no driver: no devices
  }
  return devices;
}

uint32_t select_device(const std::vector<DeviceDetails>& devices, const std::string& selector) {
  if (devices.empty()) fail(ExitCode::device, "Vulkan", "no device was found; {}", describe_driver_files());
  const bool is_index =
      !selector.empty() &&
      std::all_of(selector.begin(), selector.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  std::vector<const DeviceDetails*> named;
  for (const DeviceDetails& device : devices) {
    uint32_t index = 0;
    if (is_index) {
      const auto [end, error] = std::from_chars(selector.data(), selector.data() + selector.size(), index);
      if (error == std::errc() && index == device.index) named.push_back(&device);
    } else if (selector == "gpu" || lower(device.name).find(lower(selector)) != std::string::npos) {
      named.push_back(&device);
    }
  }
  if (named.empty()) {
    fail(ExitCode::device, "--device " + selector, "no such device; there are: {}, and cpu, gpu and auto; {}",
         list_names(devices), describe_driver_files());
  }
  for (const DeviceDetails* device : named) {
    if (device->unusable.empty()) return device->index;
  }
  fail(ExitCode::device, named.front()->name, "it lacks {}; there are: {}; {}",
       fmt::join(named.front()->unusable, ", "), list_names(devices), describe_driver_files());
}

}  // namespace lodestone::host
