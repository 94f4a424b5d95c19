// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lodestone/scene/text_reader.h"

namespace lodestone::geometry_image {
namespace {

struct Tally {
  uint64_t count = 0;
  uint32_t first = 0;  // triangle of the assembly
};

std::string place(const scene::Scene& scene, const scene::Assembly& assembly, uint32_t triangle) {
  const scene::AssemblyPart& part = assembly.parts[assembly.triangles[triangle].w];
  const std::string& name = scene.meshes[part.mesh].name;
  return fmt::format("triangle {} of mesh {}{}", part.first_mesh_triangle + (triangle - part.first_triangle),
                     part.mesh, name.empty() ? "" : " '" + scene::printable(name) + "'");
}

}  // namespace

void report_survey(const scene::Scene& scene, const scene::Assembly& assembly, const TriangleSurvey& survey,
                   AtlasReport& report) {
  std::array<Tally, size_t(TriangleFate::dropped_duplicate) + 1> tallies;
  for (uint32_t t = 0; t < survey.fates.size(); ++t) {
    Tally& tally = tallies[size_t(survey.fates[t])];
    if (tally.count++ == 0) tally.first = t;
  }
  const auto note = [&](TriangleFate fate, const char* what) {
    const Tally& tally = tallies[size_t(fate)];
    if (tally.count == 0) return;
    report.notes.push_back(fmt::format("{} triangle{} {}; the first is {}.", tally.count,
                                       tally.count == 1 ? "" : "s", what,
                                       place(scene, assembly, tally.first)));
  };
  note(TriangleFate::dropped_collapsed, "with two corners at one point: not drawn");
  note(TriangleFate::dropped_flat, "without an area in any pose: not drawn");
  note(TriangleFate::kept_flat,
       "without an area in the rest pose: kept, a pose may open them or they seal a gap");
  note(TriangleFate::dropped_duplicate, "given a second time: not drawn again");
  const auto count = [&](TriangleFate fate) { return tallies[size_t(fate)].count; };
  report.triangles = survey.fates.size();
  report.degenerate_triangles = count(TriangleFate::dropped_collapsed) + count(TriangleFate::dropped_flat) +
                                count(TriangleFate::kept_flat);
  report.duplicate_triangles = count(TriangleFate::dropped_duplicate);
  report.boundary_edges = survey.boundary_edges;
  report.non_manifold_edges = survey.non_manifold_edges;
  if (report.boundary_edges != 0) {
    report.notes.push_back(
        fmt::format("{} edges have one triangle: the surface is open.", report.boundary_edges));
  }
  if (report.non_manifold_edges != 0) {
    report.notes.push_back(fmt::format("{} edges have more than two triangles.", report.non_manifold_edges));
  }
}

}  // namespace lodestone::geometry_image
