// SPDX-License-Identifier: MIT
// From the input mesh to an atlas (section 3.1 of the paper). The paper parameterises each surface over a few
// large charts and resamples it (mapped_charts.h), and so do we, but for two other kinds that keep the
// input's own triangles: a mesh that is a grid of samples already is a chart as it stands, and any triangle
// can be a small chart of its own.
#include "lodestone/geometry_image/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "lodestone/base/error.h"
#include "lodestone/base/parallel.h"
#include "lodestone/geometry_image/atlas_objects.h"
#include "lodestone/geometry_image/chart_boxes.h"
#include "lodestone/geometry_image/charts.h"
#include "lodestone/geometry_image/mapped_charts.h"
#include "lodestone/geometry_image/notes.h"
#include "lodestone/geometry_image/slots.h"
#include "lodestone/geometry_image/triangle_survey.h"
#include "lodestone/geometry_image/weld.h"

namespace lodestone::geometry_image {
namespace {

// Which placements become grid charts.
std::vector<bool> choose_kinds(const scene::Scene& scene, const scene::Assembly& assembly, AtlasKind kind) {
  std::vector<bool> as_grid;
  std::vector<bool> checked(scene.meshes.size(), false);
  for (const scene::Placement& placement : assembly.placements) {
    const scene::Mesh& mesh = scene.meshes[placement.mesh];
    if (kind == AtlasKind::grid && mesh.grids.empty() && !mesh.triangles.empty()) {
      fail(ExitCode::usage, "--atlas",
           "grid needs meshes that are grids of samples, and mesh {} '{}' of {} is none; "
           "use --atlas auto",
           placement.mesh, mesh.name, scene.name);
    }
    const bool may_be_grid = kind == AtlasKind::automatic || kind == AtlasKind::grid;
    as_grid.push_back(may_be_grid && !mesh.grids.empty());
    if (as_grid.back() && !checked[placement.mesh]) {
      check_grids(scene, mesh);
      checked[placement.mesh] = true;
    }
  }
  return as_grid;
}

// Resamples the triangles that get no chart of their own; those that cannot be mapped get one.
MappedCharts map_surfaces(const scene::Scene& scene, const scene::Assembly& assembly,
                          const std::vector<uint32_t>& welded, const std::vector<bool>& as_grid,
                          const AtlasSettings& settings, TriangleSurvey& survey, AtlasReport& report,
                          const OnStage& on_stage) {
  std::vector<uint32_t> triangles;
  for (size_t p = 0; p < as_grid.size(); ++p) {
    const scene::Placement& placement = assembly.placements[p];
    for (uint32_t i = 0; !as_grid[p] && i < scene.meshes[placement.mesh].triangles.size(); ++i)
      if (!is_dropped(survey.fates[placement.first_triangle + i]))
        triangles.push_back(placement.first_triangle + i);
  }
  if (triangles.empty()) return {};
  MappedCharts mapped = map_charts(scene, assembly, welded, triangles, settings.charts, on_stage);
  std::vector<uint32_t> done;
  std::set_difference(triangles.begin(), triangles.end(), mapped.left_out.begin(), mapped.left_out.end(),
                      std::back_inserter(done));
  for (const uint32_t t : done) survey.fates[t] = TriangleFate::mapped;
  report.mapped_triangles = done.size();
  report.mapped_charts = mapped.charts.size();
  report.repeated_texels = mapped.repeated_texels;
  report.mean_stretch = mapped.mean_stretch;
  report.high_stretch = mapped.high_stretch;
  if (settings.charts.texel_budget != 0 && mapped.texels.size() > settings.charts.texel_budget) {
    report.notes.push_back(fmt::format("{} texels were asked for, but its {} charts need {} at least.",
                                       settings.charts.texel_budget, mapped.charts.size(),
                                       mapped.texels.size()));
  }
  if (!mapped.left_out.empty()) {
    report.notes.push_back(fmt::format(
        "{} triangles are not resampled and get a chart each: surfaces that fall apart into pieces of "
        "one or two triangles, or that no chart can be mapped to; the first is triangle {}.",
        mapped.left_out.size(), mapped.left_out.front()));
  }
  return mapped;
}

// Charts and texel map. Welds and surveys; what these need is freed before the other maps are made.
void chart_surface(const scene::Scene& scene, const scene::Assembly& assembly, const AtlasSettings& settings,
                   Atlas& atlas, const OnStage& on_stage) {
  if (on_stage) on_stage("survey");
  const std::vector<bool> as_grid = choose_kinds(scene, assembly, settings.kind);
  const std::vector<uint32_t> welded = weld(assembly);
  TriangleSurvey survey = survey_triangles(scene, assembly, welded, as_grid);
  for (uint32_t v = 0; v < welded.size(); ++v) atlas.report.welded_vertices += welded[v] == v ? 0 : 1;
  report_survey(scene, assembly, survey, atlas.report);
  MappedCharts mapped;
  if (settings.kind == AtlasKind::charts || settings.kind == AtlasKind::automatic)
    mapped = map_surfaces(scene, assembly, welded, as_grid, settings, survey, atlas.report, on_stage);
  atlas.charts = make_charts(scene, assembly, survey, as_grid);
  atlas.texel_map = make_texel_map(atlas.charts);
  const auto first_chart = static_cast<uint32_t>(atlas.charts.size());
  const auto first_texel = static_cast<uint32_t>(atlas.texel_map.size());
  for (layout::ChartRecord& chart : mapped.charts) {
    chart.first_texel += first_texel;
    atlas.charts.push_back(chart);
  }
  for (const glm::uvec4& texel : mapped.texels)
    atlas.texel_map.push_back(texel + glm::uvec4(0, 0, 0, first_chart));
  if (!mapped.maps.empty()) {
    atlas.maps.sites.assign(first_texel, {glm::vec2(0), layout::no_index, 1});
    atlas.maps.append(mapped.maps);
  }
  if (atlas.charts.empty()) {
    fail_input(scene.name, "none of its {} triangles has an area in any pose; there is nothing to draw",
               assembly.triangles.size());
  }
}

// Of one object after the other.
Atlas build_objects(const scene::Scene& scene, const scene::Assembly& assembly, const AtlasSettings& settings,
                    ChartOrder order, const OnStage& on_stage) {
  const std::vector<double> areas = object_areas(scene, assembly);
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  Atlas atlas;
  std::vector<AtlasReport> reports;
  for (size_t i = 0; i < assembly.objects.size(); ++i) {
    AtlasSettings own = settings;
    if (settings.charts.texel_budget != 0) {
      const double share = area > 0 ? areas[i] / area : 1 / double(areas.size());
      const double texels = std::ceil(double(settings.charts.texel_budget) * share);
      own.charts.texel_budget = std::max<uint64_t>(static_cast<uint64_t>(texels), 1);
    }
    const Atlas part = build_atlas(scene, scene::assemble_object(scene, assembly, i), own, order, on_stage);
    append(part, assembly.objects[i].first_triangle, scene.name, atlas);
    reports.push_back(part.report);
  }
  join_stretch(reports, areas, atlas.report);
  atlas.kind = kind_of(atlas.charts);
  return atlas;
}

}  // namespace

Atlas build_atlas(const scene::Scene& scene, const scene::Assembly& assembly, const AtlasSettings& settings,
                  const OnStage& on_stage) {
  return build_atlas(scene, assembly, settings, ChartOrder::median, on_stage);
}

Atlas build_atlas(const scene::Scene& scene, const scene::Assembly& assembly, const AtlasSettings& settings,
                  ChartOrder order, const OnStage& on_stage) {
  if (assembly.objects.size() > 1) return build_objects(scene, assembly, settings, order, on_stage);
  Atlas atlas;
  chart_surface(scene, assembly, settings, atlas, on_stage);
  atlas.kind = kind_of(atlas.charts);
  if (on_stage) on_stage("order");
  std::vector<ChartBox> boxes;
  if (atlas.charts.size() > 1)
    boxes = chart_boxes(assembly.triangles, scene::rest_positions(scene, assembly), atlas.charts,
                        atlas.texel_map);
  const uint64_t slots = assign_slots(atlas.charts, boxes, order, scene.name);
  atlas.objects.push_back(
      {tree_depth(slots), 0, static_cast<uint32_t>(slots), 0, static_cast<uint32_t>(atlas.texel_map.size())});
  atlas.leaf_map = make_leaf_map(atlas.charts, slots);
  atlas.report.texels = atlas.texel_map.size();
  atlas.report.slots = slots;
  for (const layout::ChartRecord& chart : atlas.charts) {
    atlas.report.quads += chart.kind == layout::chart_exact ? 3 : quad_count(chart);
  }
  return atlas;
}

}  // namespace lodestone::geometry_image
