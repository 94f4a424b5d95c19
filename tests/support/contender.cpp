// SPDX-License-Identifier: MIT
#include "lodestone/test_support/contender.h"

#include <cmath>

#include "lodestone/test_support/devices.h"

namespace lodestone::test {

Contender::Contender(const ReadyScene& ready, const std::string& device,
                     const render::BackendOptions& options, const std::string& traversal)
    : device_(device), backend_(open(device, options)) {
  render::Settings settings;
  settings.width = settings.height = 512;  // as many pixels as there are rays, for `auto`
  for (const auto each : {render::Traversal::threaded, render::Traversal::octant, render::Traversal::wide,
                          render::Traversal::tile}) {
    if (traversal == to_string(each)) settings.traversal = each;
  }
  renderer_ =
      std::make_unique<render::Renderer>(*backend_, ready.scene, ready.assembly, ready.atlas, settings);
}

PassSeconds Contender::take_passes() {
  PassSeconds sums;
  for (const render::PassRecord& pass : backend_->finish())
    sums[pass.name] += (std::isnan(pass.device_ms) ? pass.wall_ms : pass.device_ms) / 1e3;
  return sums;
}

render::Counters Contender::take_counters(const std::string& name) {
  render::Counters sum;
  for (const render::PassRecord& pass : backend_->finish()) {
    if (pass.name != name) continue;
    sum.rays += pass.counters.rays;
    sum.node_visits += pass.counters.node_visits;
    sum.box_tests += pass.counters.box_tests;
    sum.triangle_tests += pass.counters.triangle_tests;
  }
  return sum;
}

}  // namespace lodestone::test
