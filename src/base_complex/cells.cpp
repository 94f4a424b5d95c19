// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "lodestone/base/parallel.h"

namespace lodestone::base_complex {
namespace {

constexpr double far_away = std::numeric_limits<double>::infinity();
constexpr uint64_t faces_a_task = 1u << 12;
constexpr int smoothings = 12;  // of normals, so that noise and small bumps do not steer the cells

struct Front {
  double cost;
  uint32_t face, seed;
  // A priority queue gives the cheapest; ties go to the lower face, so that nothing depends on chance.
  bool operator<(const Front& other) const {
    return cost != other.cost ? cost > other.cost : face > other.face;
  }
};

struct Far {
  double cost;
  uint32_t face;
  // The other way round: the dearest first.
  bool operator<(const Far& other) const {
    return cost != other.cost ? cost < other.cost : face > other.face;
  }
};

class Grower {
 public:
  Grower(const HalfEdgeMesh& mesh, const CellOptions& options) : mesh_(mesh), options_(options) {
    const uint32_t faces = mesh.faces();
    centroids_.resize(faces);
    normals_.resize(faces);
    areas_.resize(faces);
    parallel_for(faces, faces_a_task, [&](uint64_t begin, uint64_t end) {
      for (auto f = static_cast<uint32_t>(begin); f < end; ++f) {
        centroids_[f] = mesh.centroid(f);
        normals_[f] = mesh.normal(f);
        areas_[f] = mesh.area(f);
      }
    });
    for (int i = 0; i < smoothings; ++i) smooth_normals();
    cost_.assign(faces, far_away);
    reached_ = centroids_;
    is_thin_.resize(faces);
    for (uint32_t f = 0; f < faces; ++f) is_thin_[f] = is_thin(f);
    seed_of_.assign(faces, none);
  }

  Cells run() {
    find_regions();
    limit_ = cell_radius(mesh_, options_) * reach_of_a_cell;
    for (const std::vector<uint32_t>& region : regions_) {
      seed(region);
      for (uint32_t i = 0; i < options_.relaxations; ++i) {
        if (!recentre(region)) break;
      }
      first_seed_ = static_cast<uint32_t>(seeds_.size());
    }
    Cells result;
    result.of_face = std::move(seed_of_);
    result.count = static_cast<uint32_t>(seeds_.size());
    return result;
  }

 private:
  // The farthest face of a round cell is this many radii of the mean cell away: cells are no discs, and
  // farthest-point seeds leave some larger than others.
  static constexpr double reach_of_a_cell = 2.2;

  bool is_thin(uint32_t face) const {
    constexpr double aspect = 15;  // of the longest edge to the height above it
    double longest = 0;
    for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) longest = std::max(longest, mesh_.length(h));
    return longest * longest > 2 * aspect * areas_[face];
  }

  void smooth_normals() {
    std::vector<glm::dvec3> smooth(normals_.size());
    parallel_for(normals_.size(), faces_a_task, [&](uint64_t begin, uint64_t end) {
      for (auto f = static_cast<uint32_t>(begin); f < end; ++f) {
        glm::dvec3 sum = normals_[f] * areas_[f];
        for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
          if (mesh_.is_barrier(h)) continue;
          const uint32_t other = face_of(mesh_.twin(h));
          sum += normals_[other] * areas_[other];
        }
        const double length = glm::length(sum);
        smooth[f] = length > 0 ? sum / length : normals_[f];
      }
    });
    normals_ = std::move(smooth);
  }

  // Faces that are connected without crossing a barrier.
  void find_regions() {
    std::vector<bool> seen(mesh_.faces(), false);
    std::vector<uint32_t> stack;
    for (uint32_t start = 0; start < mesh_.faces(); ++start) {
      if (seen[start]) continue;
      seen[start] = true;
      stack = {start};
      std::vector<uint32_t>& region = regions_.emplace_back();
      while (!stack.empty()) {
        const uint32_t face = stack.back();
        stack.pop_back();
        region.push_back(face);
        for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
          if (mesh_.is_barrier(h) || seen[face_of(mesh_.twin(h))]) continue;
          seen[face_of(mesh_.twin(h))] = true;
          stack.push_back(face_of(mesh_.twin(h)));
        }
      }
      std::sort(region.begin(), region.end());
    }
  }

  // Lets the fronts that are in the queue run; they take what they reach more cheaply than others did.
  void spread() {
    while (!queue_.empty()) {
      const Front front = queue_.top();
      queue_.pop();
      if (front.cost != cost_[front.face] || front.seed != seed_of_[front.face]) continue;
      const glm::dvec3 seed_normal = normals_[seeds_[front.seed]];
      for (uint32_t h = 3 * front.face; h < 3 * front.face + 3; ++h) {
        if (mesh_.is_barrier(h)) continue;
        const uint32_t other = face_of(mesh_.twin(h));
        const double turn = 1 - glm::dot(seed_normal, normals_[other]);
        const glm::dvec3 middle = 0.5 * (mesh_.position(mesh_.from(h)) + mesh_.position(mesh_.to(h)));
        const glm::dvec3& at = is_thin_[other] ? middle : centroids_[other];
        const double cost =
            front.cost + glm::distance(reached_[front.face], at) * (1 + options_.normal_weight * turn);
        if (cost < cost_[other]) enter(other, front.seed, cost, at);
      }
    }
  }
  void enter(uint32_t face, uint32_t seed, double cost, const glm::dvec3& at) {
    cost_[face] = cost;
    reached_[face] = at;
    seed_of_[face] = seed;
    queue_.push({cost, face, seed});
  }

  // Pieces of so few triangles of the input are one cell, or as few as make discs, however long they are:
  // arcs between more would cost more than they give.
  bool is_small(const std::vector<uint32_t>& region) const {
    constexpr size_t few = 100;
    std::vector<uint32_t> triangles;
    for (const uint32_t face : region) triangles.push_back(mesh_.triangle(face));
    std::sort(triangles.begin(), triangles.end());
    return size_t(std::unique(triangles.begin(), triangles.end()) - triangles.begin()) <= few;
  }

  // One seed, and another where the region is farthest from all so far, until nothing is too far.
  void seed(const std::vector<uint32_t>& region) {
    const auto grow_from = [&](uint32_t face) {
      seeds_.push_back(face);
      enter(face, static_cast<uint32_t>(seeds_.size() - 1), 0, centroids_[face]);
      spread();
    };
    grow_from(region.front());
    if (is_small(region)) return;
    // Faces only come nearer, so what is on top is the farthest where its distance is still true.
    std::priority_queue<Far> farthest;
    for (const uint32_t face : region)
      if (cost_[face] > limit_) farthest.push({cost_[face], face});
    while (!farthest.empty()) {
      const Far top = farthest.top();
      farthest.pop();
      if (top.cost == cost_[top.face]) {
        grow_from(top.face);
      } else if (cost_[top.face] > limit_) {
        farthest.push({cost_[top.face], top.face});
      }
    }
  }

  // Moves the region's seeds to the face nearest to the middle of their cells and grows the cells anew.
  // False where none moved.
  bool recentre(const std::vector<uint32_t>& region) {
    const size_t count = seeds_.size() - first_seed_;
    std::vector<glm::dvec3> middle(count, glm::dvec3(0));
    std::vector<double> area(count, 0), nearest(count, far_away);
    for (const uint32_t face : region) {
      middle[seed_of_[face] - first_seed_] += centroids_[face] * areas_[face];
      area[seed_of_[face] - first_seed_] += areas_[face];
    }
    bool moved = false;
    std::vector<uint32_t> found(count, none);
    for (const uint32_t face : region) {
      const size_t i = seed_of_[face] - first_seed_;
      if (!(area[i] > 0)) continue;
      const double distance = glm::distance(centroids_[face], middle[i] / area[i]);
      if (distance < nearest[i]) {
        nearest[i] = distance;
        found[i] = face;
      }
    }
    for (const uint32_t face : region) cost_[face] = far_away;
    for (size_t i = 0; i < count; ++i) {
      uint32_t& seed = seeds_[first_seed_ + i];
      if (found[i] != none && found[i] != seed) {
        seed = found[i];
        moved = true;
      }
      enter(seed, static_cast<uint32_t>(first_seed_ + i), 0, centroids_[seed]);
    }
    spread();
    return moved;
  }

  const HalfEdgeMesh& mesh_;
  const CellOptions& options_;
  std::vector<glm::dvec3> centroids_, normals_;
  // Where fronts have come to in each face: its centroid; in thin ones the middle of the edge that they came
  // over, for from centroid to centroid they would zigzag.
  std::vector<glm::dvec3> reached_;
  std::vector<bool> is_thin_;
  std::vector<double> areas_, cost_;
  std::vector<uint32_t> seed_of_, seeds_;
  std::vector<std::vector<uint32_t>> regions_;
  std::priority_queue<Front> queue_;
  double limit_ = 0;
  uint32_t first_seed_ = 0;  // of the region at hand
};

}  // namespace

double cell_radius(double area, const CellOptions& options) {
  return std::sqrt(area / (std::max(options.cells, 1u) * std::numbers::pi));
}

double cell_radius(const HalfEdgeMesh& mesh, const CellOptions& options) {
  double area = 0;
  glm::dvec3 lo(far_away), hi(-far_away);
  for (uint32_t f = 0; f < mesh.faces(); ++f) {
    area += mesh.area(f);
    for (const uint32_t point : mesh.corners(f)) {
      lo = glm::min(lo, mesh.position(point));
      hi = glm::max(hi, mesh.position(point));
    }
  }
  if (mesh.faces() == 0) return 0;
  return std::max(cell_radius(area, options), 0.5 * glm::distance(lo, hi) / std::max(options.cells, 1u));
}

Cells grow_cells(HalfEdgeMesh& mesh, const CellOptions& options) {
  Cells cells = Grower(mesh, options).run();
  constexpr uint32_t some = 1000;
  cells.most_faces = 2 * mesh.faces() + some;
  make_discs(mesh, cells);
  return cells;
}

uint32_t next_on_boundary(const HalfEdgeMesh& mesh, const std::vector<uint32_t>& cell_of_face,
                          uint32_t half_edge) {
  const uint32_t cell = cell_of_face[face_of(half_edge)];
  uint32_t h = next(half_edge);
  while (mesh.twin(h) != none && cell_of_face[face_of(mesh.twin(h))] == cell) h = next(mesh.twin(h));
  return h;
}

std::vector<std::vector<uint32_t>> faces_by_cell(const Cells& cells) {
  std::vector<std::vector<uint32_t>> faces(cells.count);
  for (uint32_t f = 0; f < cells.of_face.size(); ++f) faces[cells.of_face[f]].push_back(f);
  return faces;
}

}  // namespace lodestone::base_complex
