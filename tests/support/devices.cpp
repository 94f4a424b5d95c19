// SPDX-License-Identifier: MIT
#include "lodestone/test_support/devices.h"

#include <cstdlib>

#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/host/vulkan_backend.h"

namespace lodestone::test {
namespace {

constexpr const char* lavapipe_driver = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";

// Both drivers at once, so that a device can be had by name.
void name_drivers() {
  const char* swiftshader = std::getenv("LODESTONE_SWIFTSHADER_ICD");
  std::string files = lavapipe_driver;
  if (swiftshader != nullptr) files += std::string(":") + swiftshader;
  ::setenv("VK_DRIVER_FILES", files.c_str(), 1);
}

}  // namespace

std::vector<std::string> device_names() {
  std::vector<std::string> names = {"cpu", "llvmpipe"};
  if (std::getenv("LODESTONE_SWIFTSHADER_ICD") != nullptr) names.emplace_back("SwiftShader");
  return names;
}

std::vector<std::string> judged_device_names() {
  std::vector<std::string> names = device_names();
  if (std::getenv("LODESTONE_ALL_TESTS") == nullptr) std::erase(names, "SwiftShader");
  return names;
}

std::vector<std::string> vulkan_device_names() {
  std::vector<std::string> names = device_names();
  names.erase(names.begin());
  return names;
}

std::unique_ptr<render::Backend> open(const std::string& name, const render::BackendOptions& options) {
  if (name == "cpu") return cpu_fallback::make_cpu_backend(options);
  name_drivers();
  return host::make_backend(name, options);
}

std::unique_ptr<render::Backend> open_split(const std::string& name, uint64_t max_buffer_bytes,
                                            const render::BackendOptions& options) {
  name_drivers();
  host::HostOptions host_options;
  host_options.max_buffer_bytes = max_buffer_bytes;
  return host::make_backend(name, options, host_options);
}

}  // namespace lodestone::test
