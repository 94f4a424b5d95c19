// SPDX-License-Identifier: MIT
#include "lodestone/app/open_device.h"

#include <algorithm>

#include "lodestone/app/clock.h"
#include "lodestone/base/log.h"
#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/host/device_list.h"
#include "lodestone/host/vulkan_backend.h"

namespace lodestone::app {
namespace {

// What `auto` means on this machine.
std::string choose_device() {
  const std::vector<host::DeviceDetails> devices = host::list_devices();
  const bool usable = std::any_of(devices.begin(), devices.end(),
                                  [](const host::DeviceDetails& device) { return device.unusable.empty(); });
  if (usable) return "gpu";
  log::warn(devices.empty()
                ? "no Vulkan device was found; the CPU renders instead"
                : "no Vulkan device has what is needed (see `lodestone devices`); the CPU renders instead");
  return "cpu";
}

}  // namespace

OpenDevice open_device(const DeviceOptions& options) {
  const std::string name = options.device == "auto" ? choose_device() : options.device;
  if (name == "cpu" && options.backend.validate)
    log::warn("--validate has no effect: the CPU runs without Vulkan, and so without its validation layers");
  OpenDevice device;
  device.backend = name == "cpu" ? cpu_fallback::make_cpu_backend(options.backend)
                                 : host::make_backend(name, options.backend);
  device.origin_ms = now_ms();
  log::note(device.backend->info().name + ", " + device.backend->info().driver);
  return device;
}

void fail_on_late_messages() {
  host::fail_on_messages("Vulkan", host::take_late_messages());
}

}  // namespace lodestone::app
