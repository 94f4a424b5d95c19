// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "lodestone/app/describe.h"
#include "lodestone/image/image.h"

namespace lodestone::app {
namespace {

using Json = nlohmann::ordered_json;

// Smallest and largest finite sample, and how many are not finite.
Json describe_channel(const image::Channel& channel) {
  Json json = {{"name", channel.name}};
  if (!channel.ids.empty()) {
    const auto [lo, hi] = std::minmax_element(channel.ids.begin(), channel.ids.end());
    json["type"] = "uint";
    json["min"] = *lo;
    json["max"] = *hi;
    return json;
  }
  std::vector<float> finite;
  std::copy_if(channel.values.begin(), channel.values.end(), std::back_inserter(finite),
               [](float value) { return std::isfinite(value); });
  json["type"] = "float";
  json["min"] = json["max"] = nullptr;
  if (!finite.empty()) {
    const auto [lo, hi] = std::minmax_element(finite.begin(), finite.end());
    json["min"] = *lo;
    json["max"] = *hi;
  }
  json["non_finite"] = channel.values.size() - finite.size();
  return json;
}

}  // namespace

Json describe_image(const std::string& file) {
  const image::Image image = image::read(file);
  Json channels = Json::array();
  for (const image::Channel& channel : image.channels) channels.push_back(describe_channel(channel));
  return {{"image", file},          {"width", image.width}, {"height", image.height},
          {"linear", image.linear}, {"channels", channels}, {"metadata", Json(image.metadata)}};
}

}  // namespace lodestone::app
