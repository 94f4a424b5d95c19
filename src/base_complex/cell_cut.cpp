// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/cell_cut.h"

#include <algorithm>
#include <unordered_map>

namespace lodestone::base_complex {
namespace {

class CellCutter {
 public:
  CellCutter(HalfEdgeMesh& mesh, Cells& cells, std::vector<std::vector<uint32_t>>& faces, uint32_t cell)
      : mesh_(mesh), cells_(cells), faces_(faces), cell_(cell) {}

  bool run(uint32_t first, uint32_t second) {
    const glm::dvec3 from = mesh_.centroid(first), to = mesh_.centroid(second);
    normal_ = to - from;
    middle_ = 0.5 * (from + to);
    for (const uint32_t face : faces_[cell_])
      for (const uint32_t point : mesh_.corners(face)) side_.emplace(point, height(point));
    pull_near_points();
    split_edges();
    return part();
  }

 private:
  double height(uint32_t point) const { return glm::dot(mesh_.position(point) - middle_, normal_); }

  // Points that are nearly on the plane count as on it, so that no sliver is cut off.
  void pull_near_points() {
    constexpr double near = 0.1;  // of an edge
    for (const uint32_t face : faces_[cell_]) {
      for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
        double &a = side_.at(mesh_.from(h)), &b = side_.at(mesh_.to(h));
        if (!(a * b < 0)) continue;
        const double fraction = a / (a - b);
        if (fraction < near) a = 0;
        if (fraction > 1 - near) b = 0;
      }
    }
  }

  void split_edges() {
    for (size_t i = 0; i < faces_[cell_].size(); ++i) {
      for (uint32_t k = 0; k < 3;) {
        const uint32_t h = 3 * faces_[cell_][i] + k;
        const double a = side_.at(mesh_.from(h)), b = side_.at(mesh_.to(h));
        if (!(a * b < 0)) {
          ++k;
          continue;
        }
        std::vector<HalfEdgeMesh::Halves> halves;
        side_.emplace(mesh_.split_edge(h, a / (a - b), &halves), 0.0);
        for (const HalfEdgeMesh::Halves& half : halves) {
          cells_.of_face.push_back(cells_.of_face[half.face]);
          faces_[cells_.of_face[half.face]].push_back(half.taken);
        }
        k = 0;  // the face is another one now
      }
    }
  }

  bool is_above(uint32_t face) const {
    double sum = 0;
    for (const uint32_t point : mesh_.corners(face)) sum += side_.at(point);
    return sum > 0;
  }

  // The pieces: faces on one side of the plane that are connected.
  std::vector<std::vector<uint32_t>> pieces() const {
    std::unordered_map<uint32_t, bool> seen;
    std::vector<std::vector<uint32_t>> found;
    for (const uint32_t start : faces_[cell_]) {
      if (seen[start]) continue;
      seen[start] = true;
      std::vector<uint32_t>& piece = found.emplace_back();
      piece.push_back(start);
      for (size_t i = 0; i < piece.size(); ++i) {
        for (uint32_t h = 3 * piece[i]; h < 3 * piece[i] + 3; ++h) {
          if (mesh_.is_barrier(h)) continue;
          const uint32_t other = face_of(mesh_.twin(h));
          if (cells_.of_face[other] != cell_ || is_above(other) != is_above(start) || seen[other]) continue;
          seen[other] = true;
          piece.push_back(other);
        }
      }
    }
    return found;
  }

  bool part() {
    constexpr size_t most = 4;
    constexpr double least = 0.15;  // of the area
    std::vector<std::vector<uint32_t>> found = pieces();
    if (found.size() < 2 || found.size() > most) return false;
    std::vector<double> areas;
    double area = 0;
    for (const std::vector<uint32_t>& piece : found) {
      double sum = 0;
      for (const uint32_t face : piece) sum += mesh_.area(face);
      areas.push_back(sum);
      area += sum;
    }
    if (*std::min_element(areas.begin(), areas.end()) < least * area) return false;
    for (size_t i = 0; i < found.size(); ++i) {
      std::sort(found[i].begin(), found[i].end());
      if (i == 0) {
        faces_[cell_] = std::move(found[i]);
        continue;
      }
      for (const uint32_t face : found[i]) cells_.of_face[face] = cells_.count;
      ++cells_.count;
      faces_.push_back(std::move(found[i]));
    }
    return true;
  }

  HalfEdgeMesh& mesh_;
  Cells& cells_;
  std::vector<std::vector<uint32_t>>& faces_;
  uint32_t cell_;
  glm::dvec3 normal_{0}, middle_{0};
  std::unordered_map<uint32_t, double> side_;  // of each point of the cell, its height above the plane
};

}  // namespace

bool cut_cell(HalfEdgeMesh& mesh, Cells& cells, std::vector<std::vector<uint32_t>>& faces, uint32_t cell,
              uint32_t first, uint32_t second) {
  return CellCutter(mesh, cells, faces, cell).run(first, second);
}

}  // namespace lodestone::base_complex
