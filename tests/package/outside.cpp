// SPDX-License-Identifier: MIT
// Renders one picture of a built-in scene through the installed libraries.
#include <lodestone/cpu_fallback/cpu_backend.h>
#include <lodestone/image/image.h>
#include <lodestone/render/renderer.h>
#include <lodestone/scene/load.h>

#include <cstdio>

int main(int argc, char** argv) {
  using namespace lodestone;
  if (argc != 2) return 2;
  const scene::Scene scene = scene::load("builtin:tiny");
  const scene::Assembly assembly = scene::assemble(scene);
  const auto atlas = geometry_image::build_atlas(scene, assembly, geometry_image::AtlasKind::automatic);
  const auto device = cpu_fallback::make_cpu_backend({});
  render::Settings settings;
  settings.width = settings.height = 64;
  render::Renderer renderer(*device, scene, assembly, atlas, settings);
  const scene::Pose pose = scene::evaluate(scene, 0, 0.5f);
  const auto view = render::find_view(scene, pose, "auto", scene::pose_bounds(scene, pose), 64, 64);
  const auto frame = renderer.render(pose, view);
  image::write(argv[1], frame->display);
  std::printf("wrote %s on %s\n", argv[1], device->info().name.c_str());
}
