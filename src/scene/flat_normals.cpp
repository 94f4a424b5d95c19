// SPDX-License-Identifier: MIT
#include "lodestone/scene/flat_normals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "lodestone/scene/mesh_tools.h"

namespace lodestone::scene {
namespace {

constexpr uint64_t vertex_bytes = 128, delta_bytes = sizeof(uint32_t) + 3 * sizeof(glm::vec3);

template <class T>
void copy_elements(std::vector<T>& array, const std::vector<uint32_t>& from) {
  if (array.empty()) return;
  array.reserve(array.size() + from.size());
  for (const uint32_t vertex : from) array.push_back(T(array[vertex]));
}

class FlatMesh {
 public:
  FlatMesh(Mesh& mesh, const std::vector<uint8_t>& flat, const std::function<void(uint64_t)>& charge)
      : mesh_(mesh), flat_(flat), charge_(charge), old_count_(mesh.positions.size()) {}

  void build() {
    part_corners();
    charge_(copied_.size() * vertex_bytes);
    copy_elements(mesh_.positions, copied_);
    copy_elements(mesh_.normals, copied_);
    copy_elements(mesh_.tangents, copied_);
    copy_elements(mesh_.texcoords[0], copied_);
    copy_elements(mesh_.texcoords[1], copied_);
    copy_elements(mesh_.colors, copied_);
    copy_influences();
    copy_deltas();
    set_normals();
    for (MorphTarget& target : mesh_.targets) bend_normals(target);
  }

 private:
  // The first triangle at a vertex keeps it, any other gets a copy.
  void part_corners() {
    triangle_of_.assign(old_count_, none);
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (flat_[t] == 0) continue;
      for (int corner = 0; corner < 3; ++corner) {
        uint32_t& vertex = mesh_.triangles[t][corner];
        if (triangle_of_[vertex] != none) {
          copied_.push_back(vertex);
          vertex = static_cast<uint32_t>(old_count_ + copied_.size() - 1);
          triangle_of_.push_back(none);
        }
        triangle_of_[vertex] = t;
      }
    }
  }

  void copy_influences() {
    if (mesh_.first_influence.empty()) return;
    for (const uint32_t vertex : copied_) {
      const uint32_t begin = mesh_.first_influence[vertex], end = mesh_.first_influence[vertex + 1];
      charge_((end - begin) * sizeof(Influence));
      for (uint32_t i = begin; i < end; ++i) mesh_.influences.push_back(Influence(mesh_.influences[i]));
      mesh_.first_influence.push_back(static_cast<uint32_t>(mesh_.influences.size()));
    }
  }

  // By vertex, not by target: a file may have very many targets that move next to nothing.
  void copy_deltas() {
    if (copied_.empty()) return;
    struct Delta {
      uint32_t vertex, target;
      uint64_t place;
    };
    std::vector<Delta> deltas;
    for (uint32_t t = 0; t < mesh_.targets.size(); ++t) {
      const std::vector<uint32_t>& vertices = mesh_.targets[t].vertices;
      charge_(vertices.size() * sizeof(Delta));
      for (size_t i = 0; i < vertices.size(); ++i) deltas.push_back({vertices[i], t, i});
    }
    const auto by_vertex = [](const Delta& a, const Delta& b) { return a.vertex < b.vertex; };
    std::stable_sort(deltas.begin(), deltas.end(), by_vertex);
    for (size_t i = 0; i < copied_.size(); ++i) {
      const auto [begin, end] =
          std::equal_range(deltas.begin(), deltas.end(), Delta{copied_[i], 0, 0}, by_vertex);
      charge_(static_cast<uint64_t>(end - begin) * delta_bytes);
      for (auto delta = begin; delta != end; ++delta) {
        MorphTarget& target = mesh_.targets[delta->target];
        target.vertices.push_back(static_cast<uint32_t>(old_count_ + i));
        target.positions.push_back(glm::vec3(target.positions[delta->place]));
        if (!target.normals.empty()) target.normals.push_back(glm::vec3(target.normals[delta->place]));
        if (!target.tangents.empty()) target.tangents.push_back(glm::vec3(target.tangents[delta->place]));
      }
    }
  }

  void set_normals() {
    mesh_.normals.resize(mesh_.positions.size(), glm::vec3(0));
    for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (flat_[t] == 0) continue;
      const glm::uvec3& v = mesh_.triangles[t];
      const glm::vec3 normal = facet_normal(mesh_.positions[v.x], mesh_.positions[v.y], mesh_.positions[v.z]);
      for (int corner = 0; corner < 3; ++corner) mesh_.normals[v[corner]] = normal;
    }
  }

  // A facet bends where any of its corners moves; then all three get an entry.
  void bend_normals(MorphTarget& target) {
    std::vector<uint32_t> bent;
    for (const uint32_t vertex : target.vertices) {
      if (triangle_of_[vertex] != none) bent.push_back(triangle_of_[vertex]);
    }
    if (bent.empty()) return;
    std::sort(bent.begin(), bent.end());
    bent.erase(std::unique(bent.begin(), bent.end()), bent.end());
    charge_(bent.size() * 3 * delta_bytes);
    add_missing_corners(target, bent);
    const auto place = [&target](uint32_t vertex) {
      return static_cast<size_t>(std::lower_bound(target.vertices.begin(), target.vertices.end(), vertex) -
                                 target.vertices.begin());
    };
    for (const uint32_t t : bent) {
      const glm::uvec3& v = mesh_.triangles[t];
      const size_t at[3] = {place(v.x), place(v.y), place(v.z)};
      glm::vec3 corners[3];
      for (int c = 0; c < 3; ++c) corners[c] = mesh_.positions[v[c]] + target.positions[at[c]];
      const glm::vec3 before = mesh_.normals[v.x], after = facet_normal(corners[0], corners[1], corners[2]);
      const bool both = before != glm::vec3(0) && after != glm::vec3(0);
      for (const size_t i : at) target.normals[i] = both ? after - before : glm::vec3(0);
    }
  }

  void add_missing_corners(MorphTarget& target, const std::vector<uint32_t>& bent) const {
    const size_t known = target.vertices.size();
    target.normals.resize(known, glm::vec3(0));
    for (const uint32_t t : bent) {
      for (int corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = mesh_.triangles[t][corner];
        const auto end = target.vertices.begin() + static_cast<std::ptrdiff_t>(known);
        if (std::binary_search(target.vertices.begin(), end, vertex)) continue;
        target.vertices.push_back(vertex);
      }
    }
    target.positions.resize(target.vertices.size(), glm::vec3(0));
    target.normals.resize(target.vertices.size(), glm::vec3(0));
    if (!target.tangents.empty()) target.tangents.resize(target.vertices.size(), glm::vec3(0));
    if (target.vertices.size() == known) return;
    std::vector<size_t> order(target.vertices.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return target.vertices[a] < target.vertices[b]; });
    reorder(target.vertices, order);
    reorder(target.positions, order);
    reorder(target.normals, order);
    reorder(target.tangents, order);
  }

  template <class T>
  static void reorder(std::vector<T>& array, const std::vector<size_t>& order) {
    if (array.empty()) return;
    std::vector<T> ordered;
    ordered.reserve(array.size());
    for (const size_t i : order) ordered.push_back(array[i]);
    array = std::move(ordered);
  }

  Mesh& mesh_;
  const std::vector<uint8_t>& flat_;
  const std::function<void(uint64_t)>& charge_;
  size_t old_count_;
  std::vector<uint32_t> copied_;       // what the vertices from old_count_ on are copies of
  std::vector<uint32_t> triangle_of_;  // of every vertex that is a corner of a flat triangle
};

}  // namespace

void make_flat(Mesh& mesh, const std::vector<uint8_t>& flat, const std::function<void(uint64_t)>& charge) {
  FlatMesh(mesh, flat, charge).build();
}

}  // namespace lodestone::scene
