// SPDX-License-Identifier: MIT
// Where the Vulkan loader looks for drivers, for messages that explain why there is no device.
#pragma once

#include <string>

namespace lodestone::host {

// "driver files tried: /usr/share/vulkan/icd.d/lvp_icd.x86_64.json; /x.json (does not exist)", with the
// variable that chose them; or which folders were searched in vain.
std::string describe_driver_files();

}  // namespace lodestone::host
