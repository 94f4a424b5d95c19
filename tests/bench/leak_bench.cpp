// SPDX-License-Identifier: MIT
// The leak check at length: leak_bench SCENE DEVICE RAYS, e.g. leak_bench armadillo.obj cpu 100000000.
// Exit code 1 where a ray leaks.
#include <fmt/format.h>

#include <cstdlib>

#include "lodestone/base/error.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/leak_check.h"

int main(int argc, char** argv) try {
  using namespace lodestone;
  if (argc != 4) {
    fmt::print(stderr, "usage: leak_bench SCENE|sphere:N DEVICE RAYS\n");
    return 2;
  }
  const std::string spec = argv[1];
  const test::ReadyScene ready = spec.starts_with("sphere:")
                                     ? test::ReadyScene(test::grid_sphere(std::atoi(spec.c_str() + 7)))
                                     : test::ReadyScene(spec);
  const scene::Pose pose = ready.pose(0);
  const auto texels = ready.texels(pose);
  const auto quads = test::quad_triangles(ready.atlas);
  const auto origins = test::points_inside(texels, quads, 16, 3);
  if (origins.empty()) {
    fmt::print(stderr, "{}: no point is inside: not a closed mesh\n", spec);
    return 3;
  }
  const auto backend = test::open(argv[2]);
  render::Settings settings;
  settings.width = settings.height = 8;
  render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
  renderer.update(pose);
  const auto report =
      test::check_leaks(renderer, texels, quads, origins, std::strtoull(argv[3], nullptr, 10), 5);
  fmt::print("{}: {} rays from {} points inside on {}, {}: {} leaks\n", spec, report.rays, report.origins,
             backend->info().name, to_string(renderer.traversal()), report.leaks);
  return report.leaks == 0 ? 0 : 1;
} catch (const lodestone::Error& error) {
  fmt::print(stderr, "{}\n", error.what());
  return static_cast<int>(error.code());
}
