// SPDX-License-Identifier: MIT
// From the input mesh to an atlas (section 3.1 of the paper). Where the paper parameterises each surface over
// a few large charts and resamples it, the two kinds here keep the input's own triangles: a mesh that is a
// grid of samples already is a chart as it stands, and any other triangle becomes a small chart of its own.
#include "lodestone/geometry_image/build.h"

#include <algorithm>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/base/parallel.h"
#include "lodestone/geometry_image/charts.h"
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
           "use --atlas exact",
           placement.mesh, mesh.name, scene.name);
    }
    as_grid.push_back(kind != AtlasKind::exact && !mesh.grids.empty());
    if (as_grid.back() && !checked[placement.mesh]) {
      check_grids(scene, mesh);
      checked[placement.mesh] = true;
    }
  }
  return as_grid;
}

// Middle of a chart's bounding box.
glm::vec3 center(const scene::Assembly& assembly, const std::vector<glm::vec3>& positions,
                 const layout::ChartRecord& chart) {
  glm::vec3 lo = positions[assembly.triangles[chart.first_triangle].x], hi = lo;
  for (uint64_t i = 0; i < triangle_count(chart); ++i) {
    const glm::uvec4& triangle = assembly.triangles[chart.first_triangle + i];
    for (glm::length_t corner = 0; corner < 3; ++corner) {
      lo = glm::min(lo, positions[triangle[corner]]);
      hi = glm::max(hi, positions[triangle[corner]]);
    }
  }
  // A transform may overflow; where the chart is put then does not matter, but numbers must have an order.
  glm::vec3 middle = 0.5f * lo + 0.5f * hi;
  for (glm::length_t axis = 0; axis < 3; ++axis)
    middle[axis] = std::isfinite(middle[axis]) ? middle[axis] : 0.0f;
  return middle;
}

// In the rest pose.
std::vector<glm::vec3> chart_centers(const scene::Scene& scene, const scene::Assembly& assembly,
                                     const std::vector<layout::ChartRecord>& charts) {
  constexpr uint64_t grain = 1u << 10;
  const scene::Pose rest = scene::evaluate(scene, scene::none, 0);
  const std::vector<glm::vec3> positions = scene::blended_positions(
      assembly, scene::frame_weights(scene, assembly, rest), scene::frame_matrices(scene, assembly, rest));
  std::vector<glm::vec3> centers(charts.size());
  parallel_for(charts.size(), grain, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) centers[i] = center(assembly, positions, charts[i]);
  });
  return centers;
}

// Welds and surveys; what these need is freed before the maps are made.
std::vector<layout::ChartRecord> chart_surface(const scene::Scene& scene, const scene::Assembly& assembly,
                                               AtlasKind kind, AtlasReport& report) {
  const std::vector<bool> as_grid = choose_kinds(scene, assembly, kind);
  const std::vector<uint32_t> welded = weld(assembly);
  const TriangleSurvey survey = survey_triangles(scene, assembly, welded, as_grid);
  for (uint32_t v = 0; v < welded.size(); ++v) report.welded_vertices += welded[v] == v ? 0 : 1;
  report_survey(scene, assembly, survey, report);
  std::vector<layout::ChartRecord> charts = make_charts(scene, assembly, survey, as_grid);
  if (charts.empty()) {
    fail_input(scene.name, "none of its {} triangles has an area in any pose; there is nothing to draw",
               assembly.triangles.size());
  }
  return charts;
}

}  // namespace

Atlas build_atlas(const scene::Scene& scene, const scene::Assembly& assembly, AtlasKind kind) {
  return build_atlas(scene, assembly, kind, ChartOrder::median);
}

Atlas build_atlas(const scene::Scene& scene, const scene::Assembly& assembly, AtlasKind kind,
                  ChartOrder order) {
  Atlas atlas;
  atlas.charts = chart_surface(scene, assembly, kind, atlas.report);
  atlas.kind = kind_of(atlas.charts);
  std::vector<glm::vec3> centers;
  if (atlas.charts.size() > 1) centers = chart_centers(scene, assembly, atlas.charts);
  const uint64_t slots = assign_slots(atlas.charts, centers, order, scene.name);
  atlas.depth = tree_depth(slots);
  atlas.texel_map = make_texel_map(atlas.charts);
  atlas.leaf_map = make_leaf_map(atlas.charts, slots);
  atlas.report.texels = atlas.texel_map.size();
  atlas.report.slots = slots;
  for (const layout::ChartRecord& chart : atlas.charts) {
    atlas.report.quads += chart.kind == layout::chart_exact ? 3 : quad_count(chart);
  }
  return atlas;
}

}  // namespace lodestone::geometry_image
