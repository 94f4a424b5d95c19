// SPDX-License-Identifier: MIT
// The leak check at length: leak_bench SCENE DEVICE RAYS [exact|charts], e.g. leak_bench armadillo.obj cpu
// 100000000. RAYS are shared between the parts of the scene that are closed. Exit code 1 where a ray leaks.
#include <fmt/format.h>

#include <cstdlib>

#include "lodestone/base/error.h"
#include "lodestone/scene/load.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/leak_check.h"

namespace lodestone::test {
namespace {

constexpr uint32_t origin_count = 64;

struct Closed {
  std::string name;
  ReadyScene ready;
  std::vector<glm::vec3> origins;
};

std::vector<glm::vec3> origins_of(const ReadyScene& ready) {
  return points_inside(ready.texels(ready.pose(0)), quad_triangles(ready.atlas), origin_count, 3);
}

// The scene where it is closed as a whole, or else each of its nodes that is closed by itself.
std::vector<Closed> closed_parts(const std::string& spec, geometry_image::AtlasKind kind) {
  const scene::Scene whole = spec.starts_with("sphere:")
                                 ? grid_sphere(static_cast<uint32_t>(std::atoi(spec.c_str() + 7)))
                                 : scene::load(spec);
  std::vector<Closed> parts;
  const auto add = [&](const std::string& name, scene::Scene scene) {
    ReadyScene ready(std::move(scene), kind);
    std::vector<glm::vec3> origins = origins_of(ready);
    if (!origins.empty()) parts.push_back({name, std::move(ready), std::move(origins)});
  };
  add(spec, whole);
  for (uint32_t kept = 0; kept < whole.nodes.size() && whole.nodes.size() > 1; ++kept) {
    if (whole.nodes[kept].mesh == scene::none) continue;
    scene::Scene alone = whole;
    for (uint32_t node = 0; node < alone.nodes.size(); ++node) {
      if (node != kept) alone.nodes[node].mesh = alone.nodes[node].skin = scene::none;
    }
    add(fmt::format("{} node {} ({})", spec, kept, whole.nodes[kept].name), std::move(alone));
  }
  return parts;
}

uint64_t leaks(const Closed& part, const std::string& device, uint64_t rays) {
  const auto texels = part.ready.texels(part.ready.pose(0));
  const auto backend = open(device);
  render::Settings settings;
  settings.width = settings.height = 8;
  render::Renderer renderer(*backend, part.ready.scene, part.ready.assembly, part.ready.atlas, settings);
  renderer.update(part.ready.pose(0));
  const LeakReport report =
      check_leaks(renderer, texels, quad_triangles(part.ready.atlas), part.origins, rays, 5);
  fmt::print("{}: {} rays from {} points inside on {}, {}: {} leaks\n", part.name, report.rays,
             report.origins, backend->info().name, to_string(renderer.traversal()), report.leaks);
  if (report.leaks > 0) {
    fmt::print("  the first from {} {} {} towards {} {} {}\n", report.origin.x, report.origin.y,
               report.origin.z, report.direction.x, report.direction.y, report.direction.z);
  }
  std::fflush(stdout);
  return report.leaks;
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) try {
  using namespace lodestone;
  if (argc != 4 && argc != 5) {
    fmt::print(stderr, "usage: leak_bench SCENE|sphere:N DEVICE RAYS [exact|charts]\n");
    return 2;
  }
  const std::string kind = argc == 5 ? argv[4] : "auto";
  const std::vector<test::Closed> parts =
      test::closed_parts(argv[1], kind == "exact"    ? geometry_image::AtlasKind::exact
                                  : kind == "charts" ? geometry_image::AtlasKind::charts
                                                     : geometry_image::AtlasKind::automatic);
  if (parts.empty()) {
    fmt::print(stderr, "{}: no point is inside: nothing in it is closed\n", argv[1]);
    return 3;
  }
  uint64_t leaks = 0;
  for (const test::Closed& part : parts)
    leaks += test::leaks(part, argv[2], std::strtoull(argv[3], nullptr, 10) / parts.size());
  return leaks == 0 ? 0 : 1;
} catch (const lodestone::Error& error) {
  fmt::print(stderr, "{}\n", error.what());
  return static_cast<int>(error.code());
}
