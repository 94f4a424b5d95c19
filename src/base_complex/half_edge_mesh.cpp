// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/half_edge_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <utility>

namespace lodestone::base_complex {
namespace {

// What an edge is found by: its points, the lower one first.
uint64_t edge_key(uint32_t a, uint32_t b) {
  return (uint64_t(std::min(a, b)) << 32) | std::max(a, b);
}

struct KeyedEdge {
  uint64_t key;
  uint32_t half_edge;
};

}  // namespace

HalfEdgeMesh::HalfEdgeMesh(std::vector<glm::dvec3> positions, std::span<const glm::uvec3> triangles)
    : positions_(std::move(positions)) {
  for (glm::dvec3& p : positions_)
    for (glm::length_t axis = 0; axis < 3; ++axis) p[axis] = std::isfinite(p[axis]) ? p[axis] : 0.0;
  const size_t half_edges = 3 * triangles.size();
  from_.reserve(half_edges);
  for (const glm::uvec3& t : triangles) from_.insert(from_.end(), {t.x, t.y, t.z});
  twin_.assign(half_edges, none);
  ring_.resize(half_edges);
  ring_back_.resize(half_edges);
  name_.resize(half_edges);
  barrier_.assign(half_edges, 0);
  triangle_.resize(triangles.size());
  std::iota(triangle_.begin(), triangle_.end(), 0u);
  barycentrics_.resize(half_edges);
  for (size_t h = 0; h < half_edges; ++h)
    barycentrics_[h] = {h % 3 == 0 ? 1.0 : 0.0, h % 3 == 1 ? 1.0 : 0.0, h % 3 == 2 ? 1.0 : 0.0};

  std::vector<KeyedEdge> edges(half_edges);
  for (uint32_t h = 0; h < half_edges; ++h) edges[h] = {edge_key(from(h), to(h)), h};
  std::sort(edges.begin(), edges.end(), [](const KeyedEdge& a, const KeyedEdge& b) {
    return a.key != b.key ? a.key < b.key : a.half_edge < b.half_edge;
  });
  std::vector<uint32_t> same;
  for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    same.clear();
    for (end = begin; end < edges.size() && edges[end].key == edges[begin].key; ++end)
      same.push_back(edges[end].half_edge);
    link(same);
    if (same.size() == 2 && from(same[0]) != from(same[1])) connect(same[0], same[1]);
  }
}

void HalfEdgeMesh::connect(uint32_t a, uint32_t b) {
  twin_[a] = b;
  if (b != none) twin_[b] = a;
}

void HalfEdgeMesh::link(const std::vector<uint32_t>& half_edges) {
  for (size_t i = 0; i < half_edges.size(); ++i) {
    const uint32_t h = half_edges[i], behind = half_edges[(i + 1) % half_edges.size()];
    ring_[h] = behind;
    ring_back_[behind] = h;
    name_[h] = half_edges.front();
  }
}

// Many faces may share an edge: nothing here takes longer for it, but where the edge loses its name.
void HalfEdgeMesh::replace_in_ring(uint32_t old_one, uint32_t new_one) {
  const uint32_t before = ring_back_[old_one], behind = ring_[old_one];
  if (before == old_one) {
    link({new_one});
    return;
  }
  ring_[before] = ring_back_[behind] = new_one;
  ring_[new_one] = behind;
  ring_back_[new_one] = before;
  name_[new_one] = name_[old_one];
  if (name_[old_one] != old_one) return;
  name_[new_one] = new_one;
  for (uint32_t h = behind; h != new_one; h = ring_[h]) name_[h] = new_one;
}

void HalfEdgeMesh::make_barrier(uint32_t half_edge) {
  barrier_[half_edge] = 1;
  for (uint32_t h = ring_[half_edge]; h != half_edge; h = ring_[h]) barrier_[h] = 1;
}

// Splits the face of one half-edge; the two halves of that edge get no twin and are rings of their own yet.
uint32_t HalfEdgeMesh::split_face(uint32_t half_edge, uint32_t point, double fraction) {
  const uint32_t face = face_of(half_edge), after = next(half_edge), before = previous(half_edge);
  const uint32_t taken = faces();
  const glm::dvec3 middle = barycentrics_[half_edge] * (1 - fraction) + barycentrics_[after] * fraction;
  triangle_.push_back(triangle_[face]);
  from_.insert(from_.end(), {point, from_[after], from_[before]});
  barycentrics_.insert(barycentrics_.end(), {middle, barycentrics_[after], barycentrics_[before]});
  const uint32_t edge = 3 * taken, moved = edge + 1, inner = edge + 2;
  // The edge opposite the first corner now belongs to the new face.
  twin_.insert(twin_.end(), {none, none, none});
  barrier_.insert(barrier_.end(), {barrier_[half_edge], barrier_[after], 0});
  for (std::vector<uint32_t>* list : {&ring_, &ring_back_, &name_})
    list->insert(list->end(), {edge, moved, inner});
  replace_in_ring(after, moved);
  if (twin_[after] != none) connect(moved, twin_[after]);
  from_[after] = point;
  barycentrics_[after] = middle;
  barrier_[after] = 0;
  link({after, inner});
  connect(after, inner);
  twin_[half_edge] = none;
  return taken;
}

uint32_t HalfEdgeMesh::split_edge(uint32_t half_edge, double fraction, std::vector<Halves>* halves) {
  const uint32_t point = points(), start = from(half_edge);
  const glm::dvec3 place = positions_[start] * (1 - fraction) + positions_[to(half_edge)] * fraction;
  positions_.push_back(place);
  const uint32_t opposite = twin_[half_edge];
  // The ring is taken apart before anything moves.
  std::vector<uint32_t> ring = {half_edge};
  for (uint32_t h = ring_[half_edge]; h != half_edge; h = ring_[h]) ring.push_back(h);
  std::vector<uint32_t> near_start, near_end;
  for (const uint32_t h : ring) {
    const bool along = from(h) == start;
    const uint32_t taken = split_face(h, point, along ? fraction : 1 - fraction);
    if (halves != nullptr) halves->push_back({face_of(h), taken});
    (along ? near_start : near_end).push_back(h);
    (along ? near_end : near_start).push_back(3 * taken);
  }
  link(near_start);
  link(near_end);
  if (opposite != none) {
    connect(near_start[0], near_start[1]);
    connect(near_end[0], near_end[1]);
  }
  return point;
}

void HalfEdgeMesh::split_longer_than(double length, uint32_t most_faces) {
  struct Long {
    double length;
    uint32_t half_edge, from, to;
    bool operator<(const Long& other) const {
      return length != other.length ? length < other.length : half_edge > other.half_edge;
    }
  };
  std::priority_queue<Long> queue;
  const auto consider = [&](uint32_t h) {
    const double found = this->length(h);
    if (found > length) queue.push({found, h, from(h), to(h)});
  };
  for (uint32_t h = 0; h < from_.size(); ++h)
    if (edge_name(h) == h) consider(h);
  while (!queue.empty() && faces() < most_faces) {
    const Long top = queue.top();
    queue.pop();
    // Splitting beside it may have given the half-edge another edge; that one is in the queue by itself.
    if (from(top.half_edge) != top.from || to(top.half_edge) != top.to) continue;
    std::vector<Halves> halves;
    split_edge(top.half_edge, 0.5, &halves);
    for (const Halves& half : halves) {
      for (uint32_t k = 0; k < 3; ++k) {
        consider(3 * half.face + k);
        consider(3 * half.taken + k);
      }
    }
  }
}

double HalfEdgeMesh::area(uint32_t face) const {
  const auto [a, b, c] = corners(face);
  return 0.5 * glm::length(glm::cross(positions_[b] - positions_[a], positions_[c] - positions_[a]));
}

glm::dvec3 HalfEdgeMesh::normal(uint32_t face) const {
  const auto [a, b, c] = corners(face);
  const glm::dvec3 across = glm::cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
  const double size = glm::length(across);
  return size > 0 ? across / size : glm::dvec3(0);
}

glm::dvec3 HalfEdgeMesh::centroid(uint32_t face) const {
  const auto [a, b, c] = corners(face);
  return (positions_[a] + positions_[b] + positions_[c]) / 3.0;
}

}  // namespace lodestone::base_complex
