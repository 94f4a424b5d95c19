// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/weld.h"

#include "lodestone/geometry_image/first_equal.h"

namespace lodestone::geometry_image {
namespace {

// Walks over the morph entries of a vertex that move it.
class Moves {
 public:
  Moves(const scene::Assembly& assembly, uint32_t vertex)
      : entry_(assembly.morphs.data() + assembly.first_morph[vertex]),
        end_(assembly.morphs.data() + assembly.first_morph[vertex + 1]) {
    skip_zeros();
  }
  bool done() const { return entry_ == end_; }
  const scene::MorphEntry& operator*() const { return *entry_; }
  void next() {
    ++entry_;
    skip_zeros();
  }

 private:
  void skip_zeros() {
    while (entry_ != end_ && entry_->position == glm::vec3(0)) ++entry_;
  }
  const scene::MorphEntry* entry_;
  const scene::MorphEntry* end_;
};

bool same_moves(const scene::Assembly& assembly, uint32_t a, uint32_t b) {
  Moves of_a(assembly, a), of_b(assembly, b);
  for (; !of_a.done() && !of_b.done(); of_a.next(), of_b.next()) {
    if ((*of_a).weight != (*of_b).weight || (*of_a).position != (*of_b).position) return false;
  }
  return of_a.done() && of_b.done();
}

bool same_influences(const scene::Assembly& assembly, uint32_t a, uint32_t b) {
  const uint32_t first_a = assembly.first_influence[a], first_b = assembly.first_influence[b];
  const uint32_t count = assembly.first_influence[a + 1] - first_a;
  if (assembly.first_influence[b + 1] - first_b != count) return false;
  for (uint32_t i = 0; i < count; ++i) {
    const scene::MatrixInfluence& of_a = assembly.influences[first_a + i];
    const scene::MatrixInfluence& of_b = assembly.influences[first_b + i];
    if (of_a.matrix != of_b.matrix || of_a.weight != of_b.weight) return false;
  }
  return true;
}

uint32_t hash_vertex(const scene::Assembly& assembly, uint32_t vertex) {
  WordHash hash;
  const auto add = [&](const glm::vec3& v) {
    hash.add(v.x);
    hash.add(v.y);
    hash.add(v.z);
  };
  add(assembly.positions[vertex]);
  for (Moves moves(assembly, vertex); !moves.done(); moves.next()) {
    hash.add(uint64_t((*moves).weight));
    add((*moves).position);
  }
  for (uint32_t i = assembly.first_influence[vertex]; i < assembly.first_influence[vertex + 1]; ++i) {
    hash.add(uint64_t(assembly.influences[i].matrix));
    hash.add(assembly.influences[i].weight);
  }
  return hash.value();
}

}  // namespace

bool same_deformation(const scene::Assembly& assembly, uint32_t a, uint32_t b) {
  return a == b || (same_influences(assembly, a, b) && same_moves(assembly, a, b));
}

std::vector<uint32_t> weld(const scene::Assembly& assembly) {
  return first_equal(
      static_cast<uint32_t>(assembly.positions.size()),
      [&](uint32_t vertex) { return hash_vertex(assembly, vertex); },
      [&](uint32_t a, uint32_t b) {
        return assembly.positions[a] == assembly.positions[b] && same_deformation(assembly, a, b);
      });
}

}  // namespace lodestone::geometry_image
