// SPDX-License-Identifier: MIT
// Figures 8 and 9 of the paper, rendered and timed, and the head of table 1 as it looks at four resolutions.
// figures_bench --images FOLDER [--spp 256] [--glossy-spp 64] [--scale 1] [--devices cpu,llvmpipe] [--parts
// FOLDER]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lodestone/base/file.h"
#include "lodestone/scene/load.h"
#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/head_chart.h"
#include "lodestone/test_support/markdown_table.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

struct Choice {
  std::filesystem::path images;
  std::string parts;
  std::vector<std::string> devices{"cpu", "llvmpipe"};
  std::vector<uint32_t> resolutions{8, 32, 128, 512};
  uint32_t spp = 256, glossy_spp = 64;
  double scale = 1;  // of the pictures' sides
};

struct Shot {
  const char* figure;
  const char* scene;
  const char* camera;
  float time;
  render::Integrator integrator;
  uint32_t width, height, spp;
};

// All devices but the first take a sixteenth of the samples: they are there for their rate.
constexpr uint32_t share_of_others = 16;

class Shots {
 public:
  explicit Shots(const Choice& choice) : choice_(choice) {}

  // The picture of the first device; a row a device.
  image::Image take(Shot shot) {
    shot.width = scaled(shot.width);
    shot.height = scaled(shot.height);
    const ReadyScene ready(shot.scene);
    image::Image picture;
    for (const std::string& device : choice_.devices) {
      const bool first = device == choice_.devices.front();
      Shot shown = shot;
      if (!first) shown.spp = std::max(1u, shot.spp / share_of_others);
      const auto backend = open(device);
      render_one(ready, shown, 1, *backend);  // drivers compile
      const render::FrameResult frame = render_one(ready, shown, shown.spp, *backend);
      if (first) picture = frame.display;
      add_row(ready, shown, device, frame.wall_ms / 1e3);
    }
    return picture;
  }

  std::string table() const {
    return markdown_table({"figure", "device", "size", "samples a pixel", "camera rays", "all rays",
                           "seconds", "camera Mrays/s", "all Mrays/s"},
                          rows_);
  }

 private:
  uint32_t scaled(uint32_t side) const { return std::max(8u, uint32_t(std::lround(side * choice_.scale))); }

  static render::FrameResult render_one(const ReadyScene& ready, const Shot& shot, uint32_t spp,
                                        render::Backend& backend) {
    render::Settings settings;
    settings.width = shot.width;
    settings.height = shot.height;
    settings.spp = spp;
    settings.integrator = shot.integrator;
    const scene::Pose pose = ready.pose(shot.time);
    const render::View view = render::find_view(
        ready.scene, pose, shot.camera, scene::pose_bounds(ready.scene, pose), shot.width, shot.height);
    render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, settings);
    return *renderer.render(pose, view);
  }

  // As the kernels count them in one sample a pixel.
  static double rays_a_sample(const ReadyScene& ready, const Shot& shot) {
    render::BackendOptions counting;
    counting.counters = true;
    const auto backend = open("cpu", counting);
    double rays = 0;
    for (const render::PassRecord& pass : render_one(ready, shot, 1, *backend).passes)
      rays += double(pass.counters.rays);
    return rays;
  }

  void add_row(const ReadyScene& ready, const Shot& shot, const std::string& device, double took) {
    const double camera = double(shot.width) * shot.height * shot.spp,
                 all = rays_a_sample(ready, shot) * shot.spp;
    rows_.push_back({shot.figure, device, fmt::format("{} x {}", shot.width, shot.height),
                     std::to_string(shot.spp), fmt::format("{:.0f}", camera),
                     fmt::format("{:.3g} million", all / 1e6), fmt::format("{:.1f}", took),
                     fmt::format("{:.2f}", camera / took / 1e6), fmt::format("{:.2f}", all / took / 1e6)});
    fmt::print("{}\n", fmt::join(rows_.back(), "  "));
    std::fflush(stdout);
  }

  const Choice& choice_;
  std::vector<TableRow> rows_;
};

// The head at several resolutions, side by side.
image::Image head_sheet(const Choice& choice) {
  const auto backend = open(choice.devices.front());
  std::vector<image::Image> tiles;
  std::vector<std::string> labels;
  for (const uint32_t resolution : choice.resolutions) {
    const ReadyScene ready(head_chart(resolution));
    render::Settings settings;
    settings.width = settings.height = std::max(8u, uint32_t(std::lround(320 * choice.scale)));
    settings.spp = 16;
    const scene::Pose pose = ready.pose(1.4f);
    const render::View view = render::find_view(ready.scene, pose, "", {}, settings.width, settings.height);
    render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
    tiles.push_back(renderer.render(pose, view)->display);
    labels.push_back(fmt::format("{0} x {0}", resolution));
  }
  return image::contact_sheet(tiles, labels, uint32_t(tiles.size()));
}

void bench(const Choice& choice) {
  using render::Integrator;
  image::write(choice.images / "head.png", head_sheet(choice));
  Shots shots(choice);
  image::write(choice.images / "figure-8.png",
               shots.take({"8", "builtin:head", "", 1.4f, Integrator::dof, 598, 634, choice.spp}));
  std::vector<image::Image> tiles;
  for (const auto& [camera, figure] :
       {std::pair("island", "9, left"), std::pair("teapots", "9, center"), std::pair("handle", "9, right")})
    tiles.push_back(
        shots.take({figure, "builtin:teapots", camera, 0, Integrator::glossy, 480, 320, choice.glossy_spp}));
  image::write(choice.images / "figure-9.png", image::contact_sheet(tiles, {"left", "center", "right"}, 3));
  if (!choice.parts.empty()) write_file(std::filesystem::path(choice.parts) / "figures.md", shots.table());
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  using namespace lodestone::test;
  Choice choice;
  CLI::App app("Figures 8 and 9 of the paper", "figures_bench");
  app.add_option("--images", choice.images, "Write the pictures to this folder")->required();
  app.add_option("--parts", choice.parts, "Write tables of Markdown to this folder");
  app.add_option("--devices", choice.devices,
                 "cpu, or a part of a device's name; the first renders the pictures")
      ->delimiter(',');
  app.add_option("--resolutions", choice.resolutions, "Of the head, even")
      ->delimiter(',')
      ->check(CLI::Range(4, 4096));
  app.add_option("--spp", choice.spp, "Samples a pixel of figure 8")->check(CLI::Range(1, 65536));
  app.add_option("--glossy-spp", choice.glossy_spp, "Samples a pixel of figure 9")
      ->check(CLI::Range(1, 65536));
  app.add_option("--scale", choice.scale, "Of the pictures' sides")->check(CLI::Range(0.01, 16.0));
  return bench_main(app, argc, argv, [&] { bench(choice); });
}
