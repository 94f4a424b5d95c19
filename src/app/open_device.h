// SPDX-License-Identifier: MIT
// From the value of --device to a back end.
#pragma once

#include <memory>

#include "lodestone/app/common_options.h"
#include "lodestone/render/backend.h"

namespace lodestone::app {

// A back end and when it was made, on the clock of now_ms(): pass records count from there.
struct OpenDevice {
  std::unique_ptr<render::Backend> backend;
  double origin_ms = 0;
};

// Throws Error(device) where there is no such device, or it does not work. With `auto` and no Vulkan device
// at all: the CPU, and a warning.
OpenDevice open_device(const DeviceOptions& options);

// Throws Error(device) where the validation layers had something to say while devices were being destroyed.
// Called once all of them are.
void fail_on_late_messages();

}  // namespace lodestone::app
