// SPDX-License-Identifier: MIT
#include "lodestone/report/pass_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace lodestone::report {
namespace {

constexpr const char* row_format =
    "{:<12} {:>6} {:>11} {:>7} {:>12} {:>9} {:>10} {:>11} {:>10} {:>9} {:>8} {:>5}\n";

std::string per_ray(uint64_t count, const Counters& counters) {
  return counters.rays == 0 ? "-" : fmt::format("{:.2f}", double(count) / double(counters.rays));
}

std::string row(const PassSum& pass, std::optional<double> milliseconds, double total) {
  const auto share = [&] {
    return milliseconds && total > 0 ? fmt::format("{:.1f} %", 100 * *milliseconds / total)
                                     : std::string("-");
  };
  const std::string time = milliseconds ? fmt::format("{:.3f}", *milliseconds) : "-";
  if (!pass.counters)
    return fmt::format(fmt::runtime(row_format), pass.name, pass.calls, time, share(), pass.invocations, "-",
                       "-", "-", "-", "-", "-", "-");
  const Counters& counters = *pass.counters;
  const std::optional<double> lanes = counters.active_lanes();
  return fmt::format(fmt::runtime(row_format), pass.name, pass.calls, time, share(), pass.invocations,
                     fmt::format("{:.2f}", double(counters.bytes_read) / 1e6),
                     fmt::format("{:.2f}", double(counters.bytes_written) / 1e6),
                     counters.rays == 0 ? "-" : std::to_string(counters.rays),
                     per_ray(counters.node_visits, counters), per_ray(counters.box_tests, counters),
                     per_ray(counters.triangle_tests, counters), lanes ? fmt::format("{:.2f}", *lanes) : "-");
}

}  // namespace

std::string pass_table(const std::vector<PassSum>& passes) {
  const bool device = std::any_of(passes.begin(), passes.end(),
                                  [](const PassSum& pass) { return pass.device_ms.has_value(); });
  const auto milliseconds = [&](const PassSum& pass) {
    return device ? pass.device_ms : std::optional<double>(pass.wall_ms);
  };
  double total = 0;
  for (const PassSum& pass : passes) total += milliseconds(pass).value_or(0);
  std::string table = fmt::format(fmt::runtime(row_format), "pass", "calls", device ? "device ms" : "wall ms",
                                  "share", "invocations", "MB read", "MB written", "rays", "visits/ray",
                                  "boxes/ray", "tris/ray", "lanes");
  for (const PassSum& pass : passes) table += row(pass, milliseconds(pass), total);
  const bool untimed = std::any_of(passes.begin(), passes.end(),
                                   [&](const PassSum& pass) { return !milliseconds(pass).has_value(); });
  if (untimed) table += "(the first dispatch of a kernel is not timed: it compiles)\n";
  return table;
}

}  // namespace lodestone::report
