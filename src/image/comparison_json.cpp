// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "lodestone/image/compare.h"

namespace lodestone::image {
namespace {

using Json = nlohmann::ordered_json;

Json optional(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json channel_json(const ChannelDifference& channel) {
  const auto measured = [&](double value) { return channel.ids ? Json(nullptr) : Json(value); };
  return {{"name", channel.name},           {"type", channel.ids ? "uint" : "float"},
          {"max", measured(channel.max)},   {"mean", measured(channel.mean)},
          {"rmse", measured(channel.rmse)}, {"non_finite", channel.non_finite},
          {"different", channel.different}};
}

}  // namespace

std::string to_json(const Comparison& comparison, const std::string& a, const std::string& b) {
  const bool measured = comparison.same_size && comparison.same_channels;
  const auto value = [&](double number) { return measured ? Json(number) : Json(nullptr); };
  Json object = {{"a", a},
                 {"b", b},
                 {"pass", comparison.pass},
                 {"same_size", comparison.same_size},
                 {"same_channels", comparison.same_channels},
                 {"first_difference",
                  comparison.first_difference.empty() ? Json(nullptr) : Json(comparison.first_difference)},
                 {"max", value(comparison.max)},
                 {"mean", value(comparison.mean)},
                 {"rmse", value(comparison.rmse)},
                 {"flip_mean", optional(comparison.flip_mean)},
                 {"flip_p99", optional(comparison.flip_p99)},
                 {"pixel_share", value(comparison.pixel_share)},
                 {"channels", Json::array()},
                 {"failures", comparison.failures}};
  for (const ChannelDifference& channel : comparison.channels)
    object["channels"].push_back(channel_json(channel));
  // JSON has no infinity: the library writes null. File names may be no UTF-8.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lodestone::image
