// SPDX-License-Identifier: MIT
// Splitting cells until each is a disc.
#include <algorithm>
#include <limits>
#include <queue>
#include <unordered_map>

#include "lodestone/base_complex/cell_cut.h"
#include "lodestone/base_complex/cells.h"

namespace lodestone::base_complex {
namespace {

// Distance within a cell, from faces to faces over their common edges.
class CellDistance {
 public:
  CellDistance(const HalfEdgeMesh& mesh, const Cells& cells, const std::vector<uint32_t>& faces)
      : mesh_(mesh), cells_(cells), faces_(faces) {
    for (uint32_t i = 0; i < faces.size(); ++i) local_[faces[i]] = i;
  }

  // Of each face of the cell the source that it is nearest to.
  std::vector<uint32_t> nearest(const std::vector<uint32_t>& sources) {
    constexpr double far_away = std::numeric_limits<double>::infinity();
    cost_.assign(faces_.size(), far_away);
    entered_at_.resize(faces_.size());
    std::vector<uint32_t> source(faces_.size(), 0);
    std::priority_queue<std::pair<double, uint32_t>, std::vector<std::pair<double, uint32_t>>, std::greater<>>
        queue;
    for (uint32_t s = 0; s < sources.size(); ++s) {
      const uint32_t i = local_.at(sources[s]);
      cost_[i] = 0;
      entered_at_[i] = mesh_.centroid(sources[s]);
      source[i] = s;
      queue.push({0.0, i});
    }
    while (!queue.empty()) {
      const auto [cost, i] = queue.top();
      queue.pop();
      if (cost != cost_[i]) continue;
      const uint32_t face = faces_[i];
      for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
        if (mesh_.is_barrier(h)) continue;
        const uint32_t other = face_of(mesh_.twin(h));
        if (cells_.of_face[other] != cells_.of_face[face]) continue;
        const uint32_t j = local_.at(other);
        const glm::dvec3 middle = 0.5 * (mesh_.position(mesh_.from(h)) + mesh_.position(mesh_.to(h)));
        const double step = glm::distance(entered_at_[i], middle);
        if (cost + step < cost_[j]) {
          cost_[j] = cost + step;
          entered_at_[j] = middle;
          source[j] = source[i];
          queue.push({cost_[j], j});
        }
      }
    }
    return source;
  }

  uint32_t farthest_from(uint32_t face) {
    nearest({face});
    uint32_t best = face;
    double most = -1;
    for (uint32_t i = 0; i < faces_.size(); ++i) {
      if (faces_[i] != face && cost_[i] > most) {
        most = cost_[i];
        best = faces_[i];
      }
    }
    return best;
  }

 private:
  const HalfEdgeMesh& mesh_;
  const Cells& cells_;
  const std::vector<uint32_t>& faces_;
  std::unordered_map<uint32_t, uint32_t> local_;
  std::vector<double> cost_;
  // The middle of the edge that a face was reached over: between centroids of thin faces paths would zigzag.
  std::vector<glm::dvec3> entered_at_;
};

// Two faces of a cell between which it must be split; equal where it is a disc.
struct Cut {
  uint32_t first = 0, second = 0;
  bool straight = false;  // a plane between them will do
};

Cut far_apart(const HalfEdgeMesh& mesh, const Cells& cells, const std::vector<uint32_t>& faces) {
  CellDistance distance(mesh, cells, faces);
  const uint32_t one = distance.farthest_from(faces.front());
  return {one, distance.farthest_from(one), true};
}

class DiscCheck {
 public:
  DiscCheck(const HalfEdgeMesh& mesh, const Cells& cells, const std::vector<uint32_t>& faces)
      : mesh_(mesh), cells_(cells), faces_(faces) {}

  Cut run() {
    uint64_t interior = 0;
    std::vector<uint32_t> points;
    for (const uint32_t face : faces_) {
      for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
        points.push_back(mesh_.from(h));
        const uint32_t twin = mesh_.twin(h);
        const bool inside = twin != none && cells_.of_face[face_of(twin)] == cells_.of_face[face];
        if (inside && mesh_.is_barrier(h)) return {face, face_of(twin), false};  // a slit
        if (inside) {
          ++interior;
          continue;
        }
        const auto [place, is_new] = border_.emplace(mesh_.from(h), h);
        if (!is_new) return pinch(face_of(place->second), face);
      }
    }
    if (border_.empty()) return ends();
    std::sort(points.begin(), points.end());
    const auto distinct = std::unique(points.begin(), points.end()) - points.begin();
    const int64_t euler = distinct - int64_t(interior / 2 + border_.size()) + int64_t(faces_.size());
    find_loops();
    if (loops_.size() > 1) return across_shortest_loop();
    if (euler != 1) return ends();
    return {};
  }

 private:
  Cut pinch(uint32_t first, uint32_t second) const {
    return first != second ? Cut{first, second, false} : ends();
  }
  Cut ends() const { return far_apart(mesh_, cells_, faces_); }

  void find_loops() {
    std::unordered_map<uint32_t, bool> seen;
    for (const uint32_t face : faces_) {
      for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
        const auto start = border_.find(mesh_.from(h));
        if (start == border_.end() || start->second != h || seen[h]) continue;
        std::vector<uint32_t>& loop = loops_.emplace_back();
        for (uint32_t at = h; !seen[at]; at = border_.at(mesh_.to(at))) {
          seen[at] = true;
          loop.push_back(at);
        }
      }
    }
  }

  // A hole or the end of a tube: the border between the new cells leads through it.
  Cut across_shortest_loop() const {
    const std::vector<uint32_t>* shortest = nullptr;
    double least = 0;
    for (const std::vector<uint32_t>& loop : loops_) {
      const double length = loop_length(loop);
      if (shortest == nullptr || length < least) {
        shortest = &loop;
        least = length;
      }
    }
    double along = 0;
    const uint32_t first = face_of(shortest->front());
    uint32_t second = first;
    for (const uint32_t h : *shortest) {
      along += mesh_.length(h);
      if (face_of(h) != first) second = face_of(h);
      if (along >= 0.5 * least && second != first) break;
    }
    return second != first ? Cut{first, second, true} : ends();
  }
  double loop_length(const std::vector<uint32_t>& loop) const {
    double length = 0;
    for (const uint32_t h : loop) length += mesh_.length(h);
    return length;
  }

  const HalfEdgeMesh& mesh_;
  const Cells& cells_;
  const std::vector<uint32_t>& faces_;
  std::unordered_map<uint32_t, uint32_t> border_;  // half-edges by the point that they start at
  std::vector<std::vector<uint32_t>> loops_;
};

void split(HalfEdgeMesh& mesh, Cells& cells, std::vector<std::vector<uint32_t>>& faces, uint32_t cell,
           const Cut& cut) {
  // A few faces are parted between them.
  constexpr size_t worth_cutting = 8;
  if (cut.straight && faces[cell].size() >= worth_cutting && mesh.faces() < cells.most_faces &&
      cut_cell(mesh, cells, faces, cell, cut.first, cut.second))
    return;
  split_cell(mesh, cells, faces[cell], cut.first, cut.second);
  std::vector<uint32_t> kept, taken;
  for (const uint32_t face : faces[cell]) (cells.of_face[face] == cell ? kept : taken).push_back(face);
  faces[cell] = std::move(kept);
  faces.push_back(std::move(taken));
}

}  // namespace

void split_cell(const HalfEdgeMesh& mesh, Cells& cells, const std::vector<uint32_t>& faces, uint32_t first,
                uint32_t second) {
  const std::vector<uint32_t> nearest = CellDistance(mesh, cells, faces).nearest({first, second});
  for (size_t i = 0; i < faces.size(); ++i)
    if (nearest[i] == 1) cells.of_face[faces[i]] = cells.count;
  ++cells.count;
}

bool halve_cell(HalfEdgeMesh& mesh, Cells& cells, std::vector<std::vector<uint32_t>>& faces, uint32_t cell) {
  if (faces[cell].size() < 2) return false;
  split(mesh, cells, faces, cell, far_apart(mesh, cells, faces[cell]));
  return true;
}

void make_discs(HalfEdgeMesh& mesh, Cells& cells) {
  std::vector<std::vector<uint32_t>> faces = faces_by_cell(cells);
  for (uint32_t cell = 0; cell < faces.size();) {
    const Cut cut = DiscCheck(mesh, cells, faces[cell]).run();
    if (cut.first == cut.second) {
      ++cell;
    } else {
      split(mesh, cells, faces, cell, cut);
    }
  }
}

}  // namespace lodestone::base_complex
