// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "lodestone/base_complex/outline.h"

namespace lodestone::base_complex {
namespace {

constexpr size_t fewest_edges = 4;

bool is_border(const HalfEdgeMesh& mesh, const Cells& cells, uint32_t half_edge) {
  const uint32_t twin = mesh.twin(half_edge);
  return twin == none || cells.of_face[face_of(twin)] != cells.of_face[face_of(half_edge)];
}

// The border edges at a point, and what tells an arc that goes on there from one that ends.
class BorderGraph {
 public:
  BorderGraph(const HalfEdgeMesh& mesh, const Cells& cells) : mesh_(mesh), cells_(cells) {
    for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) {
      if (!is_border(mesh, cells, h)) continue;
      const uint32_t name = mesh.edge_name(h);
      ends_.emplace_back(mesh.from(h), name);
      ends_.emplace_back(mesh.to(h), name);
    }
    std::sort(ends_.begin(), ends_.end());
    ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
  }

  // Calls visit(point, edges), `edges` by name, for every point of a border.
  template <class Visit>
  void for_each_point(Visit visit) const {
    for (size_t begin = 0, end = 0; begin < ends_.size(); begin = end) {
      std::vector<uint32_t> edges;
      for (end = begin; end < ends_.size() && ends_[end].first == ends_[begin].first; ++end)
        edges.push_back(ends_[end].second);
      visit(ends_[begin].first, edges);
    }
  }

  bool goes_on(const std::vector<uint32_t>& edges) const {
    return edges.size() == 2 && mesh_.is_barrier(edges[0]) == mesh_.is_barrier(edges[1]) &&
           beside(edges[0]) == beside(edges[1]);
  }

 private:
  std::vector<uint32_t> beside(uint32_t edge) const {
    std::vector<uint32_t> found;
    uint32_t h = edge;
    do {
      found.push_back(cells_.of_face[face_of(h)]);
      h = mesh_.next_on_edge(h);
    } while (h != edge);
    std::sort(found.begin(), found.end());
    return found;
  }

  const HalfEdgeMesh& mesh_;
  const Cells& cells_;
  std::vector<std::pair<uint32_t, uint32_t>> ends_;  // point and edge
};

class NodeFinder {
 public:
  NodeFinder(const HalfEdgeMesh& mesh, const Cells& cells, const Boundaries& boundaries)
      : mesh_(mesh), cells_(cells), boundaries_(boundaries), is_node_(mesh.points(), false) {
    const BorderGraph graph(mesh, cells);
    graph.for_each_point([&](uint32_t point, const std::vector<uint32_t>& edges) {
      if (!graph.goes_on(edges)) is_node_[point] = true;
    });
  }

  std::vector<bool> run() {
    mark_corners_of_tiny_cells();
    for (const std::vector<uint32_t>& boundary : boundaries_) fill_up(boundary);
    while (part_equal_arcs()) {
    }
    return std::move(is_node_);
  }

 private:
  // Where a cell is a triangle of the input or two, all their corners: so the least chart is all of them.
  void mark_corners_of_tiny_cells() {
    constexpr uint32_t tiny = 2;
    std::vector<std::array<uint32_t, tiny>> triangles(cells_.count, {none, none});
    std::vector<bool> larger(cells_.count, false);
    for (uint32_t face = 0; face < mesh_.faces(); ++face) {
      const uint32_t cell = cells_.of_face[face], triangle = mesh_.triangle(face);
      std::array<uint32_t, tiny>& known = triangles[cell];
      const auto place =
          std::find_if(known.begin(), known.end(), [&](uint32_t t) { return t == triangle || t == none; });
      if (place == known.end()) {
        larger[cell] = true;
      } else {
        *place = triangle;
      }
    }
    for (uint32_t cell = 0; cell < cells_.count; ++cell) {
      if (larger[cell]) continue;
      for (const uint32_t h : boundaries_[cell]) {
        const glm::dvec3 at = mesh_.barycentrics(h);
        if (std::max({at.x, at.y, at.z}) == 1) is_node_[mesh_.from(h)] = true;
      }
    }
  }

  // At least three nodes: the sharpest corners or, where there are too few, points as far from each other as
  // can be.
  void fill_up(const std::vector<uint32_t>& boundary) {
    constexpr size_t fewest = 3;
    const Outline outline(mesh_, boundary);
    std::vector<size_t> nodes;
    for (size_t i = 0; i < boundary.size(); ++i)
      if (is_node_[mesh_.from(boundary[i])]) nodes.push_back(i);
    if (nodes.size() < fewest) {
      for (const size_t corner : sharp_corners(boundary)) {
        if (nodes.size() == fewest) break;
        if (is_node_[mesh_.from(boundary[corner])]) continue;
        nodes.push_back(corner);
        is_node_[mesh_.from(boundary[corner])] = true;
      }
    }
    if (nodes.empty()) {
      nodes.push_back(0);
      is_node_[mesh_.from(boundary[0])] = true;
    }
    while (nodes.size() < fewest) {
      size_t best = 0;
      double most = -1;
      for (size_t i = 0; i < boundary.size(); ++i) {
        double apart = outline.length;
        for (const size_t n : nodes) apart = std::min({apart, outline.between(i, n), outline.between(n, i)});
        if (is_node_[mesh_.from(boundary[i])]) continue;
        if (apart > most) {
          most = apart;
          best = i;
        }
      }
      nodes.push_back(best);
      is_node_[mesh_.from(boundary[best])] = true;
    }
  }

  // The sharpest first.
  std::vector<size_t> sharp_corners(const std::vector<uint32_t>& boundary) const {
    constexpr double sharp = 1.75;  // 100 degrees
    const std::vector<double> angles = boundary_angles(mesh_, cells_.of_face, boundary);
    std::vector<size_t> corners;
    for (size_t i = 0; i < boundary.size(); ++i)
      if (angles[i] < sharp) corners.push_back(i);
    std::stable_sort(corners.begin(), corners.end(),
                     [&](size_t a, size_t b) { return angles[a] < angles[b]; });
    return corners;
  }

  // Puts a node on one of two arcs that have the same ends. False where there are none.
  bool part_equal_arcs() {
    struct Found {
      uint32_t name;    // of the lowest edge
      uint32_t middle;  // a point inside, or none
    };
    std::map<std::pair<uint32_t, uint32_t>, Found> by_ends;
    bool parted = false;
    for (const std::vector<uint32_t>& boundary : boundaries_) {
      const size_t count = boundary.size();
      size_t start = 0;
      while (!is_node_[mesh_.from(boundary[start])]) ++start;
      for (size_t i = 0; i < count;) {
        size_t end = i + 1;
        uint32_t name = mesh_.edge_name(boundary[(start + i) % count]);
        while (!is_node_[mesh_.from(boundary[(start + end) % count])]) {
          name = std::min(name, mesh_.edge_name(boundary[(start + end) % count]));
          ++end;
        }
        const auto ends = std::minmax(
            {mesh_.from(boundary[(start + i) % count]), mesh_.from(boundary[(start + end) % count])});
        const uint32_t middle = end - i > 1 ? mesh_.from(boundary[(start + (i + end) / 2) % count]) : none;
        const auto [place, is_new] = by_ends.emplace(ends, Found{name, middle});
        if (!is_new && place->second.name != name) {
          // Either will do, but one edge alone has no point inside.
          const uint32_t node = middle != none ? middle : place->second.middle;
          if (node != none && !is_node_[node]) is_node_[node] = parted = true;
        }
        i = end;
      }
    }
    return parted;
  }

  const HalfEdgeMesh& mesh_;
  const Cells& cells_;
  const Boundaries& boundaries_;
  std::vector<bool> is_node_;
};

// Returns the new faces, which are the last.
std::vector<HalfEdgeMesh::Halves> split(HalfEdgeMesh& mesh, Cells& cells, uint32_t half_edge) {
  std::vector<HalfEdgeMesh::Halves> halves;
  mesh.split_edge(half_edge, 0.5, &halves);
  for (const HalfEdgeMesh::Halves& half : halves) cells.of_face.push_back(cells.of_face[half.face]);
  return halves;
}

void split_short_boundaries(HalfEdgeMesh& mesh, Cells& cells) {
  std::vector<size_t> edges(cells.count, 0);
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h)
    if (is_border(mesh, cells, h)) ++edges[cells.of_face[face_of(h)]];
  // Splitting an edge renames others, so whose turn it is looks for its boundary anew.
  std::vector<std::vector<uint32_t>> faces = faces_by_cell(cells);
  for (uint32_t cell = 0; cell < cells.count; ++cell) {
    for (; edges[cell] < fewest_edges; ++edges[cell]) {
      uint32_t longest = none;
      for (const uint32_t face : faces[cell])
        for (uint32_t h = 3 * face; h < 3 * face + 3; ++h)
          if (is_border(mesh, cells, h) && (longest == none || mesh.length(h) > mesh.length(longest)))
            longest = h;
      uint32_t h = longest;
      do {
        const uint32_t other = cells.of_face[face_of(h)];
        if (other != cell) ++edges[other];
        h = mesh.next_on_edge(h);
      } while (h != longest);
      for (const HalfEdgeMesh::Halves& half : split(mesh, cells, longest))
        faces[cells.of_face[half.taken]].push_back(half.taken);
    }
  }
}

void split_chords(HalfEdgeMesh& mesh, Cells& cells) {
  std::vector<bool> on_border(mesh.points(), false);
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h)
    if (is_border(mesh, cells, h)) on_border[mesh.from(h)] = on_border[mesh.to(h)] = true;
  // New points are inside cells, so new edges are no chords; but a chord may become an edge of a new face.
  const auto is_chord = [&](uint32_t h) {
    return mesh.from(h) < on_border.size() && mesh.to(h) < on_border.size() && on_border[mesh.from(h)] &&
           on_border[mesh.to(h)] && !is_border(mesh, cells, h);
  };
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h)
    if (is_chord(h)) split(mesh, cells, h);
}

}  // namespace

void split_for_boundaries(HalfEdgeMesh& mesh, Cells& cells) {
  split_short_boundaries(mesh, cells);
  split_chords(mesh, cells);
}

Boundaries trace_boundaries(const HalfEdgeMesh& mesh, const Cells& cells) {
  std::vector<uint32_t> first(cells.count, none);
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) {
    uint32_t& found = first[cells.of_face[face_of(h)]];
    if (found == none && is_border(mesh, cells, h)) found = h;
  }
  Boundaries boundaries(cells.count);
  for (uint32_t cell = 0; cell < cells.count; ++cell) {
    uint32_t h = first[cell];
    do {
      boundaries[cell].push_back(h);
      h = next_on_boundary(mesh, cells.of_face, h);
    } while (h != first[cell]);
  }
  return boundaries;
}

std::vector<bool> find_nodes(const HalfEdgeMesh& mesh, const Cells& cells, const Boundaries& boundaries) {
  return NodeFinder(mesh, cells, boundaries).run();
}

}  // namespace lodestone::base_complex
