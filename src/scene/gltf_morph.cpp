// SPDX-License-Identifier: MIT
// Morph targets (3.7.2.2) and skin influences (3.7.3.3) of a primitive.
#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/gltf_convert.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

using Deltas = std::vector<Entry<glm::vec3>>;

Deltas read_deltas(const AccessorReader& reader, const std::map<std::string, int>& attributes,
                   const char* name, size_t vertex_count, const std::string& where) {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return {};
  const std::string use = fmt::format("{}, {}", where, name);
  if (reader.count(found->second, use) != vertex_count) {
    fail_input(reader.file(), "{}: {} deltas for {} vertices; export it again", use,
               reader.count(found->second, use), vertex_count);
  }
  return reader.nonzero_vec3s(found->second, use);
}

void warn_of_other_deltas(const AccessorReader& reader, const std::map<std::string, int>& attributes,
                          const std::string& where) {
  for (const auto& [name, accessor] : attributes) {
    if (name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name.starts_with('_')) continue;
    log::warn_once(
        reader.file() + " morphs " + name,
        fmt::format("{}: {}: its deltas of {} are ignored; only POSITION, NORMAL and TANGENT are read",
                    reader.file(), where, shown(name)));
  }
}

// The value for `vertex` where the list has one at `at`, which then moves on; else zero.
glm::vec3 take(const Deltas& deltas, size_t& at, uint32_t vertex) {
  if (at < deltas.size() && deltas[at].index == vertex) return deltas[at++].value;
  return glm::vec3(0);
}

uint32_t next_index(const Deltas& deltas, size_t at) {
  return at < deltas.size() ? deltas[at].index : std::numeric_limits<uint32_t>::max();
}

// Merges the three lists; the arrays of normals and tangents stay empty until the first delta of theirs.
void append(const Deltas& positions, const Deltas& normals, const Deltas& tangents, uint32_t first_vertex,
            MorphTarget& target) {
  const bool with_normals = !normals.empty() || !target.normals.empty();
  const bool with_tangents = !tangents.empty() || !target.tangents.empty();
  if (with_normals) target.normals.resize(target.vertices.size(), glm::vec3(0));
  if (with_tangents) target.tangents.resize(target.vertices.size(), glm::vec3(0));
  size_t p = 0, n = 0, t = 0;
  while (p < positions.size() || n < normals.size() || t < tangents.size()) {
    const uint32_t vertex =
        std::min(next_index(positions, p), std::min(next_index(normals, n), next_index(tangents, t)));
    target.vertices.push_back(first_vertex + vertex);
    target.positions.push_back(take(positions, p, vertex));
    const glm::vec3 normal = take(normals, n, vertex), tangent = take(tangents, t, vertex);
    if (with_normals) target.normals.push_back(normal);
    if (with_tangents) target.tangents.push_back(tangent);
  }
}

// The sets JOINTS_n and WEIGHTS_n, n from 0 until one is missing.
struct InfluenceSet {
  std::vector<glm::uvec4> joints;
  std::vector<glm::vec4> weights;
};

std::vector<InfluenceSet> read_influence_sets(const AccessorReader& reader,
                                              const tinygltf::Primitive& primitive, size_t vertex_count,
                                              const std::string& where) {
  std::vector<InfluenceSet> sets;
  while (true) {
    const std::string joints_name = fmt::format("JOINTS_{}", sets.size());
    const std::string weights_name = fmt::format("WEIGHTS_{}", sets.size());
    const auto joints = primitive.attributes.find(joints_name),
               weights = primitive.attributes.find(weights_name);
    const bool has_joints = joints != primitive.attributes.end(),
               has_weights = weights != primitive.attributes.end();
    if (!has_joints && !has_weights) return sets;
    if (has_joints != has_weights) {
      fail_input(reader.file(), "{}: has one of {} and {} without the other; export it again", where,
                 joints_name, weights_name);
    }
    InfluenceSet set;
    const std::string joints_use = where + ", " + joints_name, weights_use = where + ", " + weights_name;
    if (reader.count(joints->second, joints_use) != vertex_count ||
        reader.count(weights->second, weights_use) != vertex_count) {
      fail_input(reader.file(), "{}: {} and {} are not one a vertex; export it again", where, joints_name,
                 weights_name);
    }
    set.joints = reader.joints(joints->second, joints_use);
    set.weights = reader.vec4s(weights->second, weights_use);
    sets.push_back(std::move(set));
  }
}

}  // namespace

void append_morph_targets(const AccessorReader& reader, const tinygltf::Primitive& primitive,
                          uint32_t first_vertex, size_t vertex_count, const std::string& where,
                          std::vector<MorphTarget>& targets) {
  for (size_t i = 0; i < primitive.targets.size(); ++i) {
    const std::string target = fmt::format("{}, morph target {}", where, i);
    const std::map<std::string, int>& attributes = primitive.targets[i];
    warn_of_other_deltas(reader, attributes, target);
    // Deltas of normals that are not there mean nothing (3.7.2.2).
    const bool has_normals = primitive.attributes.contains("NORMAL");
    append(read_deltas(reader, attributes, "POSITION", vertex_count, target),
           has_normals ? read_deltas(reader, attributes, "NORMAL", vertex_count, target) : Deltas(),
           read_deltas(reader, attributes, "TANGENT", vertex_count, target), first_vertex, targets[i]);
  }
}

void append_influences(const AccessorReader& reader, const tinygltf::Primitive& primitive,
                       size_t vertex_count, const std::string& where, Mesh& mesh) {
  const std::vector<InfluenceSet> sets = read_influence_sets(reader, primitive, vertex_count, where);
  if (mesh.first_influence.empty()) mesh.first_influence.push_back(0);
  for (size_t v = 0; v < vertex_count; ++v) {
    double sum = 0;
    for (const InfluenceSet& set : sets) {
      for (int c = 0; c < 4; ++c) {
        if (set.weights[v][c] < 0)
          fail_input(reader.file(), "{}: a negative skin weight; export it again", where);
        sum += double(set.weights[v][c]);
      }
    }
    const size_t first = mesh.influences.size();
    for (const InfluenceSet& set : sets) {
      for (int c = 0; c < 4 && sum > 0; ++c) {
        const float weight = float(double(set.weights[v][c]) / sum);
        if (weight > 0) mesh.influences.push_back({set.joints[v][c], weight});
      }
    }
    if (mesh.influences.size() == first) {
      log::warn_once(
          reader.file() + " unskinned vertices",
          fmt::format("{}: {}: vertices without skin weights follow the first joint", reader.file(), where));
      mesh.influences.push_back({0, 1.0f});
    }
    mesh.first_influence.push_back(uint32_t(mesh.influences.size()));
  }
}

}  // namespace lodestone::scene
