// SPDX-License-Identifier: MIT
// What a file holds, for `lodestone info`: JSON in the order in which it is told.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "lodestone/app/common_options.h"

namespace lodestone::app {

nlohmann::ordered_json describe_scene(const SceneOptions& options);
nlohmann::ordered_json describe_baked(const std::string& file);
nlohmann::ordered_json describe_image(const std::string& file);

// The same for people: one line a value, one line an element of an array of objects.
std::string plain_text(const nlohmann::ordered_json& description);

}  // namespace lodestone::app
