// SPDX-License-Identifier: MIT
// From what the renderer measured to what src/report prints.
#pragma once

#include <string>
#include <vector>

#include "lodestone/app/open_device.h"
#include "lodestone/app/prepared_scene.h"
#include "lodestone/report/measurements.h"

namespace lodestone::app {

std::vector<report::Dispatch> to_dispatches(const std::vector<render::PassRecord>& records, double origin_ms);

// A run with everything but its frames, its setup passes and its memory.
report::RunRecord describe_run(const std::string& command, const std::string& scene_name,
                               const PreparedScene& prepared, const PictureOptions& picture,
                               const render::DeviceInfo& device);

}  // namespace lodestone::app
