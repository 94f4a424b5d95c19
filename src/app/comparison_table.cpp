// SPDX-License-Identifier: MIT
#include "lodestone/app/comparison_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace lodestone::app {
namespace {

std::string number(double value) {
  return fmt::format("{:.6g}", value);
}

std::string line(size_t width, const std::string& name, const std::string& max, const std::string& mean,
                 const std::string& rmse, const std::string& different, const std::string& non_finite) {
  return fmt::format("{:<{}}  {:>12}  {:>12}  {:>12}  {:>10}  {:>10}\n", name, width, max, mean, rmse,
                     different, non_finite);
}

std::string channel_lines(const image::Comparison& comparison) {
  size_t width = 7;
  for (const image::ChannelDifference& channel : comparison.channels)
    width = std::max(width, channel.name.size());
  std::string text = line(width, "channel", "max", "mean", "rmse", "different", "non-finite");
  for (const image::ChannelDifference& channel : comparison.channels) {
    const auto measure = [&](double value) { return channel.ids ? "-" : number(value); };
    text += line(width, channel.name, measure(channel.max), measure(channel.mean), measure(channel.rmse),
                 std::to_string(channel.different), channel.ids ? "-" : std::to_string(channel.non_finite));
  }
  return text + fmt::format("{:<{}}  {:>12}  {:>12}  {:>12}\n", "all", width, number(comparison.max),
                            number(comparison.mean), number(comparison.rmse));
}

}  // namespace

std::string comparison_table(const image::Comparison& comparison) {
  std::string text;
  if (!comparison.channels.empty()) text += channel_lines(comparison);
  if (comparison.flip_mean)
    text += fmt::format("FLIP: mean {}, 99th percentile {}\n", number(*comparison.flip_mean),
                        number(*comparison.flip_p99));
  if (comparison.pixel_share > 0)
    text += fmt::format("share of differing pixels: {}\n", number(comparison.pixel_share));
  if (!comparison.first_difference.empty())
    text += fmt::format("first difference: {}\n", comparison.first_difference);
  for (const std::string& failure : comparison.failures) text += fmt::format("failed: {}\n", failure);
  if (comparison.pass) text += comparison.first_difference.empty() ? "equal\n" : "within the thresholds\n";
  return text;
}

}  // namespace lodestone::app
