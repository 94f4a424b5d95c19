// SPDX-License-Identifier: MIT
// The weight by angle is that of Thürmer and Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets":
// unlike area it does not depend on how a flat region was cut into triangles, which in CAD is long slivers.
#include "lodestone/scene/crease_normals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "lodestone/base/disjoint_sets.h"
#include "lodestone/scene/first_use.h"

namespace lodestone::scene {
namespace {

// The bits of a coordinate, the same for both zeros.
uint32_t bits_of(float coordinate) {
  return std::bit_cast<uint32_t>(coordinate == 0 ? 0.0f : coordinate);
}

uint32_t next_corner(uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

glm::dvec3 unit_or_zero(const glm::dvec3& vector) {
  const double length = std::sqrt(glm::dot(vector, vector));
  return length > 0 ? vector / length : glm::dvec3(0);
}

class CreasedMeshBuilder {
 public:
  CreasedMeshBuilder(std::span<const glm::vec3> corners, double crease_angle)
      : corners_(corners), least_cosine_(std::cos(crease_angle)), sets_(corners.size()) {}

  void build(Mesh& mesh) {
    join_positions();
    compute_facet_normals();
    join_over_smooth_edges();
    join_flat_triangles();
    number_vertices(mesh);
  }

 private:
  void join_positions() {
    FirstUse<3> positions;
    position_of_.reserve(corners_.size());
    for (const glm::vec3& corner : corners_) {
      position_of_.push_back(positions.number({bits_of(corner.x), bits_of(corner.y), bits_of(corner.z)}));
    }
    position_count_ = positions.keys().size();
  }

  void compute_facet_normals() {
    facet_normals_.reserve(corners_.size() / 3);
    for (size_t i = 0; i < corners_.size(); i += 3) {
      const glm::dvec3 a(corners_[i]), b(corners_[i + 1]), c(corners_[i + 2]);
      facet_normals_.push_back(unit_or_zero(glm::cross(b - a, c - a)));
    }
  }

  bool has_area(uint32_t corner) const { return facet_normals_[corner / 3] != glm::dvec3(0); }

  // An undirected edge between two positions, and the corners from which its first two triangles run along
  // it.
  struct Edge {
    uint32_t first = none, second = none;
    bool shared_by_more = false;
  };

  void join_over_smooth_edges() {
    FirstUse<2> numbers;
    std::vector<Edge> edges;
    for (uint32_t corner = 0; corner < corners_.size(); ++corner) {
      if (!has_area(corner)) continue;
      const auto [low, high] = std::minmax(position_of_[corner], position_of_[next_corner(corner)]);
      const uint32_t number = numbers.number({low, high});
      if (number == edges.size()) edges.emplace_back();
      Edge& edge = edges[number];
      if (edge.first == none) {
        edge.first = corner;
      } else if (edge.second == none) {
        edge.second = corner;
      } else {
        edge.shared_by_more = true;
      }
    }
    for (const Edge& edge : edges) {
      if (is_smooth(edge)) {
        sets_.join(edge.first, next_corner(edge.second));
        sets_.join(next_corner(edge.first), edge.second);
      }
    }
  }

  bool is_smooth(const Edge& edge) const {
    if (edge.second == none || edge.shared_by_more) return false;
    if (position_of_[edge.first] != position_of_[next_corner(edge.second)]) return false;
    return glm::dot(facet_normals_[edge.first / 3], facet_normals_[edge.second / 3]) >= least_cosine_;
  }

  // The corners of triangles without an area join the first set at their position that has a normal, or else
  // each other.
  void join_flat_triangles() {
    std::vector<uint32_t> first_at(position_count_, none);
    for (const bool with_area : {true, false}) {
      for (uint32_t corner = 0; corner < corners_.size(); ++corner) {
        uint32_t& first = first_at[position_of_[corner]];
        if (has_area(corner) == with_area && first == none) first = corner;
      }
    }
    for (uint32_t corner = 0; corner < corners_.size(); ++corner) {
      if (!has_area(corner)) sets_.join(corner, first_at[position_of_[corner]]);
    }
  }

  double angle_at(uint32_t corner) const {
    const uint32_t next = next_corner(corner), last = next_corner(next);
    const glm::dvec3 along = unit_or_zero(glm::dvec3(corners_[next]) - glm::dvec3(corners_[corner]));
    const glm::dvec3 back = unit_or_zero(glm::dvec3(corners_[last]) - glm::dvec3(corners_[corner]));
    return std::acos(std::clamp(glm::dot(along, back), -1.0, 1.0));
  }

  void number_vertices(Mesh& mesh) {
    std::vector<uint32_t> vertex_of_set(corners_.size(), none);
    std::vector<glm::dvec3> sums;
    mesh.triangles.resize(corners_.size() / 3);
    for (uint32_t corner = 0; corner < corners_.size(); ++corner) {
      uint32_t& vertex = vertex_of_set[sets_.find(corner)];
      if (vertex == none) {
        vertex = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.push_back(corners_[corner] + 0.0f);  // -0 becomes +0
        sums.emplace_back(0);
      }
      if (has_area(corner)) sums[vertex] += angle_at(corner) * facet_normals_[corner / 3];
      mesh.triangles[corner / 3][static_cast<int>(corner % 3)] = vertex;
    }
    mesh.normals.reserve(sums.size());
    for (const glm::dvec3& sum : sums) mesh.normals.emplace_back(unit_or_zero(sum));
  }

  std::span<const glm::vec3> corners_;
  double least_cosine_;
  DisjointSets sets_;                  // of corners
  std::vector<uint32_t> position_of_;  // of each corner, equal for equal positions
  size_t position_count_ = 0;
  std::vector<glm::dvec3> facet_normals_;  // unit, or zero for a triangle without an area
};

}  // namespace

void build_creased_mesh(std::span<const glm::vec3> corners, double crease_angle, Mesh& mesh) {
  CreasedMeshBuilder(corners, crease_angle).build(mesh);
}

}  // namespace lodestone::scene
