// SPDX-License-Identifier: MIT
#include "lodestone/base/hash.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/atlas_objects.h"
#include "lodestone/geometry_image/chart_seams.h"

namespace lodestone::geometry_image {
namespace {

// To be raised whenever build_atlas makes something else of the same input.
constexpr uint32_t build_version = 10;

}  // namespace

std::string atlas_hash(const scene::Scene& scene, const scene::Assembly& assembly,
                       const AtlasSettings& settings) {
  ContentHash hash;
  hash.add(std::string("geometry-image atlas"));
  hash.add_value(build_version);
  hash.add_value(settings.kind);
  hash.add_value(settings.charts.texel_budget);
  hash.add_value(settings.charts.signal);
  hash.add_value(settings.charts.all_shapes);
  hash.add_value(settings.charts.keep_maps);
  // Triangles, and what decides which vertices are one point.
  hash.add_array(assembly.placements);
  for (const scene::Object& object : assembly.objects) {
    hash.add_value(object.first_placement);
    hash.add_value(object.rigid);
  }
  hash.add_array(assembly.parts);
  hash.add_array(assembly.triangles);
  hash.add_array(assembly.positions);
  hash.add_array(assembly.first_morph);
  hash.add_array(assembly.morphs);
  hash.add_array(assembly.first_influence);
  hash.add_array(assembly.influences);
  // Where attributes change, charts of resampled surfaces are cut.
  hash.add_array(assembly.normals);
  hash.add_array(assembly.texcoords[0]);
  hash.add_array(assembly.texcoords[1]);
  hash.add_array(assembly.colors);
  for (const scene::AssemblyPart& part : assembly.parts) hash.add_value(has_texture(scene, part));
  // The rest pose, which decides the order of charts.
  const scene::Pose rest = scene::evaluate(scene, scene::none, 0);
  hash.add_array(scene::frame_weights(scene, assembly, rest));
  hash.add_array(scene::frame_matrices(scene, assembly, rest));
  if (assembly.objects.size() > 1) hash.add_array(object_areas(scene, assembly));
  if (settings.charts.signal == Signal::screen) {
    for (size_t node = 0; node < scene.nodes.size(); ++node) {
      if (scene.nodes[node].camera == scene::none) continue;
      const scene::Camera& camera = scene.cameras[scene.nodes[node].camera];
      hash.add_value(rest.node_world[node]);
      for (const float number :
           {camera.perspective ? 1.0f : 0.0f, camera.yfov, camera.aspect, camera.xmag, camera.ymag})
        hash.add_value(number);
    }
  }
  // Grids, and the names that notes mention.
  for (const scene::Placement& placement : assembly.placements) {
    const scene::Mesh& mesh = scene.meshes[placement.mesh];
    hash.add(mesh.name);
    hash.add_value(uint64_t(mesh.grids.size()));
    for (const scene::Grid& grid : mesh.grids) {
      hash.add_value(grid.width);
      hash.add_value(grid.height);
      hash.add_value(grid.first_triangle);
      hash.add_array(grid.vertices);
    }
  }
  return hash.hex();
}

}  // namespace lodestone::geometry_image
