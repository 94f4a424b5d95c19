// SPDX-License-Identifier: MIT
#include <algorithm>

#include "lodestone/app/atlas_text.h"
#include "lodestone/app/baked_scene.h"
#include "lodestone/app/describe.h"
#include "lodestone/app/stage_clock.h"
#include "lodestone/base/error.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/fidelity.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/pose.h"

namespace lodestone::app {
namespace {

using Json = nlohmann::ordered_json;

const char* to_string(geometry_image::AtlasKind kind) {
  switch (kind) {
    case geometry_image::AtlasKind::automatic:
      return "auto";
    case geometry_image::AtlasKind::grid:
      return "grid";
    case geometry_image::AtlasKind::exact:
      return "exact";
    case geometry_image::AtlasKind::charts:
      return "charts";
  }
  return "unknown";
}

const char* to_string(scene::Light::Kind kind) {
  switch (kind) {
    case scene::Light::Kind::directional:
      return "directional";
    case scene::Light::Kind::point:
      return "point";
    case scene::Light::Kind::spot:
      return "spot";
  }
  return "unknown";
}

Json array_of(const glm::vec3& vector) {
  return {vector.x, vector.y, vector.z};
}

// An array of what `describe` says of every item.
template <class Items, class Describe>
Json list(const Items& items, Describe describe) {
  Json array = Json::array();
  for (const auto& item : items) array.push_back(describe(item));
  return array;
}

Json describe_mesh(const scene::Mesh& mesh) {
  Json json = {
      {"name", mesh.name}, {"triangles", mesh.triangles.size()}, {"vertices", mesh.positions.size()}};
  if (!mesh.grids.empty()) json["grids"] = mesh.grids.size();
  if (!mesh.influences.empty()) json["influences"] = mesh.influences.size();
  json["targets"] = list(mesh.targets, [](const scene::MorphTarget& target) { return target.name; });
  return json;
}

Json describe_camera(const scene::Camera& camera) {
  Json json = {{"name", camera.name}, {"kind", camera.perspective ? "perspective" : "orthographic"}};
  if (camera.perspective) {
    json["yfov_degrees"] = glm::degrees(camera.yfov);
  } else {
    json["half_width"] = camera.xmag;
    json["half_height"] = camera.ymag;
  }
  return json;
}

Json describe_material(const scene::Material& material) {
  Json textures = Json::array();
  const std::pair<const char*, const scene::Texture&> all[] = {
      {"base_color", material.base_color_texture},
      {"metallic_roughness", material.metallic_roughness_texture},
      {"normal", material.normal_texture},
      {"occlusion", material.occlusion_texture},
      {"emissive", material.emissive_texture},
      {"specular", material.specular_texture},
      {"specular_color", material.specular_color_texture},
      {"transmission", material.transmission_texture},
      {"clearcoat", material.clearcoat_texture},
      {"clearcoat_roughness", material.clearcoat_roughness_texture},
      {"clearcoat_normal", material.clearcoat_normal_texture}};
  for (const auto& [name, texture] : all) {
    if (texture.image != scene::none) textures.push_back(name);
  }
  Json json = {{"name", material.name}, {"textures", textures}};
  if (material.transmission > 0) {
    json["transmission"] = material.transmission;
    json["ior"] = material.ior;
    json["solid"] = material.thickness > 0;
  }
  if (material.clearcoat > 0) json["clearcoat"] = material.clearcoat;
  return json;
}

Json describe_bounds(const scene::Bounds& bounds) {
  if (bounds.empty) return nullptr;
  return {{"lo", array_of(bounds.lo)}, {"hi", array_of(bounds.hi)}};
}

// Null where the file does not say (in the cache).
Json describe_source(const geometry_image::BakeRecord& record) {
  if (record.scene.empty()) return nullptr;
  Json json = {{"scene", record.scene}};
  if (record.height_scale != 0) json["height_scale"] = record.height_scale;
  json["asked_atlas"] = to_string(record.asked.kind);
  return json;
}

// In units of the diagonal of the input's box, in the rest pose; null where nothing is resampled.
Json describe_distance(const std::optional<geometry_image::Fidelity>& fidelity) {
  if (!fidelity) return nullptr;
  return {{"diagonal", fidelity->diagonal},
          {"unit", "share of the diagonal"},
          {"from_input", fidelity->from_input},
          {"from_geometry_image", fidelity->from_image},
          {"hausdorff", fidelity->hausdorff()},
          {"mean", fidelity->mean},
          {"root_mean_square", fidelity->root_mean_square}};
}

Json describe_atlas(const geometry_image::Atlas& atlas) {
  const geometry_image::AtlasReport& report = atlas.report;
  return {{"kind", to_string(atlas.kind)},
          {"charts", atlas.charts.size()},
          {"quads", report.quads},
          {"texels", report.texels},
          {"slots", report.slots},
          {"objects",
           list(atlas.objects,
                [](const geometry_image::AtlasObject& object) {
                  return Json{{"texels", object.texels}, {"slots", object.slots}, {"depth", object.depth}};
                })},
          {"closed", report.closed()},
          {"boundary_edges", report.boundary_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"degenerate_triangles", report.degenerate_triangles},
          {"duplicate_triangles", report.duplicate_triangles},
          {"welded_vertices", report.welded_vertices},
          {"mapped_triangles", report.mapped_triangles},
          {"mapped_charts", report.mapped_charts},
          {"texels_used_percent", texels_used(atlas)},
          {"stretch_mean", report.mapped_charts > 0 ? Json(report.mean_stretch) : Json(nullptr)},
          {"stretch_95th_percentile", report.mapped_charts > 0 ? Json(report.high_stretch) : Json(nullptr)},
          {"map_bytes", atlas.maps.bytes()},
          {"notes", report.notes}};
}

}  // namespace

Json describe_scene(const SceneOptions& options) {
  const scene::Scene scene = load_scene(options);
  const scene::Assembly assembly = scene::assemble(scene, instancing_of(options));
  StageClock clock(options.scene);
  const geometry_image::Atlas atlas = geometry_image::cached_atlas(
      scene, assembly, options.atlas, nullptr, [&](const char* stage) { clock.begin(stage); });
  clock.end();
  const scene::Pose rest = scene::evaluate(scene, scene::none, 0);
  return {
      {"scene", options.scene},
      {"triangles", assembly.triangles.size()},
      {"vertices", assembly.positions.size()},
      {"placements", assembly.placements.size()},
      {"objects", assembly.objects.size()},
      {"instances", assembly.instances.size()},
      {"nodes", scene.nodes.size()},
      {"bounds", describe_bounds(scene::pose_bounds(scene, rest))},
      {"meshes", list(scene.meshes, describe_mesh)},
      {"skins", list(scene.skins,
                     [](const scene::Skin& skin) {
                       return Json{{"name", skin.name}, {"joints", skin.joints.size()}};
                     })},
      {"clips", list(scene.animations,
                     [](const scene::Animation& clip) {
                       return Json{{"name", clip.name},
                                   {"seconds", clip.duration()},
                                   {"channels", clip.channels.size()}};
                     })},
      {"cameras", list(scene.cameras, describe_camera)},
      {"lights", list(scene.lights,
                      [](const scene::Light& light) {
                        return Json{{"name", light.name},
                                    {"kind", to_string(light.kind)},
                                    {"intensity", light.intensity}};
                      })},
      {"materials", list(scene.materials, describe_material)},
      {"images", list(scene.images,
                      [](const scene::Image& image) {
                        return Json{{"name", image.name}, {"width", image.width}, {"height", image.height}};
                      })},
      {"atlas", describe_atlas(atlas)},
      {"distance", describe_distance(measure_fidelity(scene, assembly, atlas, rest))},
      {"stages", list(clock.stages(), [](const report::Stage& stage) {
         return Json{{"name", stage.name}, {"wall_ms", stage.wall_ms}};
       })}};
}

Json describe_baked(const std::string& file) {
  geometry_image::BakeRecord record;
  const geometry_image::Atlas atlas = geometry_image::load_atlas(file, &record);
  Json distance = nullptr, why_not = nullptr;
  if (!record.scene.empty() && atlas.report.mapped_charts > 0) {
    // The file alone does not know the mesh.
    try {
      SceneOptions options;
      options.scene = file;
      BakedScene baked(options);
      const scene::Scene scene = baked.load();
      const scene::Assembly assembly = scene::assemble(scene, baked.instancing());
      const scene::Pose rest = scene::evaluate(scene, scene::none, 0);
      distance =
          describe_distance(measure_fidelity(scene, assembly, baked.take_atlas(scene, assembly), rest));
    } catch (const Error& error) {
      if (error.code() != ExitCode::bad_input) throw;
      why_not = error.what();
    }
  }
  return {{"baked", file},
          {"content_hash", record.content_hash},
          {"source", describe_source(record)},
          {"atlas", describe_atlas(atlas)},
          {"distance", distance},
          {"distance_not_measured", why_not}};
}

}  // namespace lodestone::app
