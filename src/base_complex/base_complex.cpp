// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/base_complex.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "lodestone/base/parallel.h"
#include "lodestone/base_complex/corners.h"
#include "lodestone/base_complex/nodes.h"
#include "lodestone/mesh/point_triangle.h"

namespace lodestone::base_complex {
namespace {

// Cuts boundaries at the nodes; the pieces are arcs, each found again by its edges.
class ArcFinder {
 public:
  ArcFinder(BaseComplex& complex, const Boundaries& boundaries, const std::vector<bool>& is_node)
      : complex_(complex), mesh_(complex.mesh), boundaries_(boundaries), is_node_(is_node) {
    arc_of_edge_.assign(3 * size_t(mesh_.faces()), none);
  }

  void run(const std::vector<std::array<uint32_t, 4>>& corners) {
    for (uint32_t c = 0; c < boundaries_.size(); ++c) {
      const std::vector<uint32_t>& boundary = boundaries_[c];
      // The first corner is a node, and the boundary starts there.
      const size_t start = corners[c][0];
      Cell& cell = complex_.cells[c];
      size_t corner = 0;
      for (size_t i = 0; i < boundary.size();) {
        size_t end = i + 1;
        while (end < boundary.size() && !is_node_[mesh_.from(at(boundary, start + end))]) ++end;
        if (corner < 4 && start + i == corners[c][corner])
          cell.corners[corner++] = static_cast<uint32_t>(cell.boundary.size());
        cell.boundary.push_back(passage(boundary, start + i, start + end));
        i = end;
      }
    }
  }

 private:
  static uint32_t at(const std::vector<uint32_t>& boundary, size_t i) {
    return boundary[i % boundary.size()];
  }

  Passage passage(const std::vector<uint32_t>& boundary, size_t begin, size_t end) {
    const uint32_t first = at(boundary, begin);
    uint32_t& known = arc_of_edge_[mesh_.edge_name(first)];
    if (known == none) {
      const auto index = static_cast<uint32_t>(complex_.arcs.size());
      Arc& arc = complex_.arcs.emplace_back();
      arc.firm = mesh_.is_barrier(first);
      for (size_t i = begin; i < end; ++i) {
        const uint32_t h = at(boundary, i);
        arc_of_edge_[mesh_.edge_name(h)] = index;
        arc.points.push_back(mesh_.from(h));
        arc.length += mesh_.length(h);
      }
      arc.points.push_back(mesh_.from(at(boundary, end)));
    }
    ++complex_.arcs[known].cells;
    return {known, complex_.arcs[known].points.front() != mesh_.from(first), first};
  }

  BaseComplex& complex_;
  const HalfEdgeMesh& mesh_;
  const Boundaries& boundaries_;
  const std::vector<bool>& is_node_;
  std::vector<uint32_t> arc_of_edge_;  // by the edge's name
};

// From a point to the polyline of an arc.
double distance_to(const HalfEdgeMesh& mesh, const Arc& arc, const glm::dvec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i + 1 < arc.points.size(); ++i) {
    const glm::dvec3 a = mesh.position(arc.points[i]), edge = mesh.position(arc.points[i + 1]) - a;
    least = std::min(least, glm::length(mesh::offset_from_segment(point - a, edge)));
  }
  return least;
}

void find_room(BaseComplex& complex) {
  const std::vector<std::vector<uint32_t>> cells = cells_beside_arcs(complex);
  parallel_for(complex.arcs.size(), 1, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      Arc& arc = complex.arcs[i];
      if (arc.firm) continue;
      arc.room.assign(arc.points.size(), std::numeric_limits<double>::infinity());
      for (const uint32_t cell : cells[i]) {
        for (const Passage& passage : complex.cells[cell].boundary) {
          const Arc& other = complex.arcs[passage.arc];
          if (!other.firm) continue;
          for (size_t p = 0; p < arc.points.size(); ++p)
            arc.room[p] =
                std::min(arc.room[p], distance_to(complex.mesh, other, complex.mesh.position(arc.points[p])));
        }
      }
    }
  });
}

std::vector<glm::dvec3> point_normals(const HalfEdgeMesh& mesh) {
  std::vector<glm::dvec3> normals(mesh.points(), glm::dvec3(0));
  for (uint32_t face = 0; face < mesh.faces(); ++face) {
    const glm::dvec3 weighted = mesh.normal(face) * mesh.area(face);
    for (const uint32_t point : mesh.corners(face)) normals[point] += weighted;
  }
  for (glm::dvec3& normal : normals) {
    const double length = glm::length(normal);
    normal = length > 0 ? normal / length : glm::dvec3(0);
  }
  return normals;
}

}  // namespace

std::vector<std::vector<uint32_t>> cells_beside_arcs(const BaseComplex& complex) {
  std::vector<std::vector<uint32_t>> cells(complex.arcs.size());
  for (uint32_t c = 0; c < complex.cells.size(); ++c)
    for (const Passage& passage : complex.cells[c].boundary) cells[passage.arc].push_back(c);
  return cells;
}

std::array<Side, 4> sides_of(const BaseComplex& complex, const Cell& cell) {
  std::array<Side, 4> sides;
  for (size_t s = 0; s < 4; ++s) {
    sides[s].first = cell.corners[s];
    sides[s].end = s < 3 ? cell.corners[s + 1] : cell.boundary.size();
    for (size_t p = sides[s].first; p < sides[s].end; ++p)
      sides[s].length += complex.arcs[cell.boundary[p].arc].length;
  }
  return sides;
}

BaseComplex build_complex(HalfEdgeMesh mesh, Cells cells) {
  BaseComplex complex(std::move(mesh));
  split_for_boundaries(complex.mesh, cells);
  const Boundaries boundaries = trace_boundaries(complex.mesh, cells);
  std::vector<bool> is_node = find_nodes(complex.mesh, cells, boundaries);
  const std::vector<std::array<uint32_t, 4>> corners =
      choose_corners(complex.mesh, cells, boundaries, is_node);
  complex.cells.resize(cells.count);
  ArcFinder(complex, boundaries, is_node).run(corners);
  find_room(complex);
  complex.normals = point_normals(complex.mesh);
  complex.cell_of_face = std::move(cells.of_face);
  for (uint32_t face = 0; face < complex.cell_of_face.size(); ++face) {
    Cell& cell = complex.cells[complex.cell_of_face[face]];
    cell.faces.push_back(face);
    cell.area += complex.mesh.area(face);
  }
  return complex;
}

}  // namespace lodestone::base_complex
