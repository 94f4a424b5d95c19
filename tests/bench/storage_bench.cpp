// SPDX-License-Identifier: MIT
// Table 2 of the paper: bits a node of the hierarchy, a ray in flight, and a triangle, from the buffers that
// a renderer really makes. storage_bench [--scene stanford_bunny.obj] [--resolution 256] [--devices
// cpu,llvmpipe] [--parts FOLDER]
#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "lodestone/base/file.h"
#include "lodestone/scene/load.h"
#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/head_chart.h"
#include "lodestone/test_support/markdown_table.h"
#include "lodestone/test_support/ready_scene.h"
#include "recording_backend.h"
#include "threaded_bvh.h"
#include "uniform_grid.h"

namespace lodestone::test {
namespace {

struct Choice {
  std::string scene = "stanford_bunny.obj";
  uint32_t resolution = 256;
  std::vector<std::string> devices{"cpu", "llvmpipe"};
  std::string parts;
};

// Bits an element.
struct PaperRow {
  const char* method;
  const char *node, *state, *triangle;
};
constexpr PaperRow paper_rows[] = {{"Karlsson, proximity cloud", "64", "64", "320"},
                                   {"Foley, backtrack", "64", "128", "320"},
                                   {"Foley, extended split", "320", "128", "320"},
                                   {"Thrane, uniform grid", "32", "256", "320"},
                                   {"Thrane, kd-restart", "128", "128", "320"},
                                   {"Thrane, kd-backtrack", "384", "128", "320"},
                                   {"Thrane, BVH", "128", "none", "320"},
                                   {"the paper's, BVH with geometry image", "160", "none", "24"}};

// What each traversal reads of the hierarchy, of the surface, and keeps of a ray between dispatches.
const std::vector<std::string> node_buffers = {"nodes_lo", "nodes_hi",    "links",      "wide_nodes",
                                               "boxes",    "leaf_blocks", "leaf_groups"};
const std::vector<std::string> state_buffers = {"loaded_states", "loaded_trails"};

// Nodes with a quad below them, the quads' own included.
uint64_t nodes_in_use(const geometry_image::Atlas& atlas) {
  std::vector<bool> used;
  for (const glm::uvec2& slot : atlas.leaf_map) used.push_back(slot.x != layout::empty_slot);
  uint64_t count = 0;
  for (uint32_t level = 0; level <= atlas.objects[0].depth; ++level) {
    count += uint64_t(std::count(used.begin(), used.end(), true));
    std::vector<bool> above((used.size() + 3) / 4);
    for (size_t i = 0; i < used.size(); ++i) above[i / 4] = above[i / 4] || used[i];
    used = std::move(above);
  }
  return count;
}

std::string bits_text(double bytes, double elements) {
  return fmt::format("{:.1f}", 8 * bytes / elements);
}

class Storage {
 public:
  void add_geometry_image(const std::string& name, const ReadyScene& ready, const std::string& device,
                          render::Traversal traversal) {
    RecordingBackend backend(open(device));
    render::Settings settings;
    settings.width = settings.height = 8;
    settings.traversal = traversal;
    render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, settings);
    constexpr uint32_t rays = 4096;
    renderer.update(ready.pose(0));
    renderer.load_rays(std::vector<glm::vec4>(2 * rays, glm::vec4(0, 0, 1, 1)));
    const bool reads_leaf_map = renderer.traversal() != render::Traversal::threaded &&
                                renderer.traversal() != render::Traversal::octant;
    const double nodes = double(nodes_in_use(ready.atlas)), triangles = 2 * double(ready.atlas.report.quads);
    double node_bytes = 0, state_bytes = 0;
    for (const std::string& buffer : node_buffers) node_bytes += double(backend.bytes(buffer));
    if (reads_leaf_map) node_bytes += double(backend.bytes("leaf_map"));
    for (const std::string& buffer : state_buffers) state_bytes += double(backend.bytes(buffer));
    const double surface = double(backend.bytes("geometry"));
    rows_.push_back({fmt::format("{}, {}", name, to_string(renderer.traversal())), device,
                     bits_text(node_bytes, nodes), bits_text(state_bytes, rays),
                     bits_text(surface, triangles),
                     fmt::format("{:.1f}", (node_bytes + surface) / triangles)});
  }

  void add_plain(const std::vector<Triangle>& triangles) {
    const double count = double(triangles.size());
    const ThreadedBvh bvh(triangles);
    const double bvh_bytes = double(bvh.nodes().size() * sizeof(ThreadedBvh::Node)),
                 surface = double(bvh.triangles().size() * sizeof(Triangle));
    rows_.push_back({"threaded BVH, plain C++", "cpu", bits_text(bvh_bytes, double(bvh.nodes().size())), "0",
                     bits_text(surface, count), fmt::format("{:.1f}", (bvh_bytes + surface) / count)});
    const UniformGrid grid(triangles, usual_density);
    const double grid_bytes = double((grid.cell_count() + 1 + grid.reference_count()) * sizeof(uint32_t));
    rows_.push_back({"uniform grid, plain C++", "cpu", bits_text(grid_bytes, double(grid.cell_count())), "0",
                     bits_text(surface, count), fmt::format("{:.1f}", (grid_bytes + surface) / count)});
  }

  std::string table() const {
    return markdown_table({"ours, measured", "device", "bits a node or cell", "bits a ray's state",
                           "bits a triangle", "bytes a triangle, all together"},
                          rows_);
  }

 private:
  std::vector<TableRow> rows_;
};

std::string paper_table() {
  std::vector<TableRow> rows;
  for (const PaperRow& row : paper_rows) rows.push_back({row.method, row.node, row.state, row.triangle});
  return markdown_table({"the paper's table 2", "bits a node", "state", "triangle"}, rows);
}

void bench(const Choice& choice) {
  const scene::Scene scene = scene::load(data_file(choice.scene).value_or(choice.scene));
  geometry_image::AtlasSettings settings(geometry_image::AtlasKind::charts);
  settings.charts.texel_budget = uint64_t(choice.resolution) * choice.resolution;
  const ReadyScene one_chart(head_chart(choice.resolution)), charts(scene, settings);
  Storage storage;
  for (const std::string& device : choice.devices) {
    for (const auto& [name, ready] : {std::pair(std::string("head, one chart"), &one_chart),
                                      std::pair(choice.scene + ", charts", &charts)}) {
      for (const render::Traversal traversal :
           {render::Traversal::threaded, render::Traversal::octant, render::Traversal::automatic})
        storage.add_geometry_image(name, *ready, device, traversal);
    }
  }
  const scene::Assembly assembly = scene::assemble(scene);
  storage.add_plain(triangles_of(scene::rest_positions(scene, assembly),
                                 {assembly.triangles.begin(), assembly.triangles.end()}));
  fmt::print("{}", storage.table());
  if (choice.parts.empty()) return;
  const std::filesystem::path folder = choice.parts;
  write_file(folder / "storage-paper.md", paper_table());
  write_file(folder / "storage.md", storage.table());
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  using namespace lodestone::test;
  Choice choice;
  CLI::App app("Table 2 of the paper: bits a node, a ray's state, a triangle", "storage_bench");
  app.add_option("--scene", choice.scene, "A file, also of the shared data folder, or builtin:NAME");
  app.add_option("--resolution", choice.resolution, "Geometry images of about N x N texels, N even")
      ->check(CLI::Range(4, 4096));
  app.add_option("--devices", choice.devices, "cpu, or a part of a device's name")->delimiter(',');
  app.add_option("--parts", choice.parts, "Write tables of Markdown to this folder");
  return bench_main(app, argc, argv, [&] { bench(choice); });
}
