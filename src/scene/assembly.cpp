// SPDX-License-Identifier: MIT
#include "lodestone/scene/assembly.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "lodestone/base/error.h"
#include "lodestone/base/memory.h"
#include "lodestone/base/parallel.h"
#include "lodestone/layout/arithmetic.h"

namespace lodestone::scene {
namespace {

constexpr uint64_t max_triangles = uint64_t(1) << 28;
constexpr uint64_t max_elements = 0xffffffffu;  // of any other array: its indices are 32-bit

// What the arrays of the assembly will hold, counted before anything is allocated.
struct Totals {
  uint64_t vertices = 0, triangles = 0, parts = 0, morphs = 0, influences = 0, weights = 0, matrices = 0;
};

bool is_skinned(const Scene& scene, const Node& node) {
  return node.skin != none && !scene.meshes[node.mesh].first_influence.empty();
}

uint64_t matrices_of(const Scene& scene, const Node& node) {
  return is_skinned(scene, node) ? scene.skins[node.skin].joints.size() : 1;
}

uint32_t influences_of(const Mesh& mesh, uint32_t vertex) {
  return mesh.first_influence[vertex + 1] - mesh.first_influence[vertex];
}

void check_limit(const Scene& scene, uint64_t count, uint64_t limit, const char* what) {
  if (count > limit) {
    fail_input(scene.name,
               "the placed meshes have {} {}, more than the {} that can be drawn; draw fewer of them", count,
               what, limit);
  }
}

void add_node(const Scene& scene, const Node& node, Totals& totals) {
  const Mesh& mesh = scene.meshes[node.mesh];
  totals.vertices += mesh.positions.size();
  totals.triangles += mesh.triangles.size();
  totals.parts += mesh.parts.size();
  for (const MorphTarget& target : mesh.targets) totals.morphs += target.vertices.size();
  // A vertex that the skin leaves out still needs one influence.
  totals.influences += mesh.positions.size() + mesh.influences.size();
  totals.weights += mesh.targets.size();
  totals.matrices += matrices_of(scene, node);
}

Totals count(const Scene& scene, const Division& division) {
  Totals totals;
  for (const ObjectNodes& object : division.objects) {
    for (const uint32_t node : object.nodes) add_node(scene, scene.nodes[node], totals);
  }
  if (totals.triangles == 0)
    fail_input(scene.name, "no node places a mesh with triangles; there is nothing to draw");
  check_limit(scene, totals.triangles, max_triangles, "triangles");
  check_limit(scene, totals.vertices, max_elements, "vertices");
  check_limit(scene, totals.morphs, max_elements, "morph deltas");
  check_limit(scene, totals.influences, max_elements, "skin influences");
  check_limit(scene, totals.weights, max_elements, "morph weights");
  check_limit(scene, totals.matrices, max_elements / 3, "joints");
  return totals;
}

// Vertices or triangles a task: enough work to pay for it.
constexpr uint64_t grain = 1u << 14;

template <class Body>
void for_each_vertex(const Mesh& mesh, const Body& body) {
  parallel_for(mesh.positions.size(), grain, [&](uint64_t begin, uint64_t end) {
    for (uint64_t v = begin; v < end; ++v) body(static_cast<uint32_t>(v));
  });
}

// As layout::unpack_vertex_color undoes it.
uint32_t pack_color(const glm::vec4& color) {
  const glm::vec4 within = glm::clamp(color, 0.0f, 1.0f);
  const glm::vec4 scaled = glm::vec4(glm::sqrt(glm::vec3(within)), within.w) * 255.0f + 0.5f;
  return uint32_t(scaled.x) | uint32_t(scaled.y) << 8 | uint32_t(scaled.z) << 16 | uint32_t(scaled.w) << 24;
}

// Tiny numbers are flushed on the way in as they are by `blend` on the way out: some devices would treat them
// as zero, others not. This also makes +0 of -0, so that equal positions have equal bits.
void copy_vertices(const Mesh& mesh, uint32_t first, Assembly& assembly) {
  for_each_vertex(mesh, [&](uint32_t v) {
    const uint32_t to = first + v;
    assembly.positions[to] = layout::flush_tiny3(mesh.positions[v]);
    assembly.normals[to] = layout::flush_tiny3(mesh.normals[v]);
    if (!mesh.tangents.empty()) {
      const glm::vec4& tangent = mesh.tangents[v];
      assembly.tangents[to] = glm::vec4(layout::flush_tiny3(glm::vec3(tangent)), tangent.w);
    }
    for (int set = 0; set < 2; ++set) {
      if (!mesh.texcoords[set].empty()) assembly.texcoords[set][to] = mesh.texcoords[set][v];
    }
    if (!mesh.colors.empty()) assembly.colors[to] = pack_color(mesh.colors[v]);
  });
}

void copy_triangles(const Mesh& mesh, const Placement& placement, Assembly& assembly) {
  for (const Part& part : mesh.parts) {
    const auto index = static_cast<uint32_t>(assembly.parts.size());
    const uint32_t first = placement.first_triangle + part.first_triangle;
    assembly.parts.push_back({part.material, placement.mesh, first, part.first_triangle});
    parallel_for(part.triangle_count, grain, [&](uint64_t begin, uint64_t end) {
      for (uint64_t t = begin; t < end; ++t) {
        const glm::uvec3& corners = mesh.triangles[part.first_triangle + t];
        assembly.triangles[first + t] = glm::uvec4(corners + placement.first_vertex, index);
      }
    });
  }
}

// Sorts the deltas of the targets by vertex. Targets are taken in order, so each vertex gets its own in order
// of weight.
void copy_morphs(const Mesh& mesh, const Placement& placement, Assembly& assembly) {
  const auto vertices = static_cast<uint32_t>(mesh.positions.size());
  std::vector<uint32_t> next(vertices, 0);
  for (const MorphTarget& target : mesh.targets) {
    for (const uint32_t v : target.vertices) ++next[v];
  }
  auto end = static_cast<uint32_t>(assembly.morphs.size());
  for (uint32_t v = 0; v < vertices; ++v) {
    const uint32_t begin = end;
    end += next[v];
    next[v] = begin;
    assembly.first_morph[placement.first_vertex + v + 1] = end;
  }
  assembly.morphs.resize(end);
  uint32_t weight = placement.first_weight;
  for (const MorphTarget& target : mesh.targets) {
    for (size_t i = 0; i < target.vertices.size(); ++i) {
      MorphEntry& entry = assembly.morphs[next[target.vertices[i]]++];
      entry.weight = weight;
      entry.position = layout::flush_tiny3(target.positions[i]);
      if (!target.normals.empty()) entry.normal = layout::flush_tiny3(target.normals[i]);
      if (!target.tangents.empty()) entry.tangent = layout::flush_tiny3(target.tangents[i]);
    }
    ++weight;
  }
}

// A vertex without a skin, or one that its skin leaves out, follows the placement's first matrix.
void copy_influences(const Mesh& mesh, const Placement& placement, bool skinned, Assembly& assembly) {
  const auto vertices = static_cast<uint32_t>(mesh.positions.size());
  const uint32_t first = placement.first_matrix;
  for (uint32_t v = 0; v < vertices; ++v) {
    if (!skinned || influences_of(mesh, v) == 0) {
      assembly.influences.push_back({first, 1.0f});
    } else {
      for (uint32_t i = mesh.first_influence[v]; i < mesh.first_influence[v + 1]; ++i) {
        const Influence& influence = mesh.influences[i];
        assembly.influences.push_back({first + influence.joint, layout::flush_tiny(influence.weight)});
      }
    }
    assembly.first_influence[placement.first_vertex + v + 1] =
        static_cast<uint32_t>(assembly.influences.size());
  }
}

// A file of a few bytes may place a mesh a million times: told before the machine is out of memory.
void require_room(const Scene& scene, const Totals& totals) {
  constexpr uint64_t vertex_bytes =
      2 * sizeof(glm::vec3) + sizeof(glm::vec4) + 2 * sizeof(glm::vec2) + 3 * sizeof(uint32_t);
  require_memory(totals.vertices * vertex_bytes + totals.triangles * sizeof(glm::uvec4) +
                     totals.morphs * sizeof(MorphEntry) + totals.influences * sizeof(MatrixInfluence),
                 scene.name);
}

Assembly allocate(const Totals& totals) {
  Assembly assembly;
  assembly.positions.resize(totals.vertices);
  assembly.normals.resize(totals.vertices);
  assembly.tangents.resize(totals.vertices, glm::vec4(0, 0, 0, 1));
  for (std::vector<glm::vec2>& set : assembly.texcoords) set.resize(totals.vertices, glm::vec2(0));
  assembly.colors.resize(totals.vertices, 0xffffffffu);
  assembly.first_morph.resize(totals.vertices + 1, 0);
  assembly.morphs.reserve(totals.morphs);
  assembly.first_influence.resize(totals.vertices + 1, 0);
  assembly.influences.reserve(totals.influences);
  assembly.triangles.resize(totals.triangles);
  assembly.parts.reserve(totals.parts);
  return assembly;
}

// `next`: where the placement of the node goes; becomes that of the one after it.
void add_placement(const Scene& scene, uint32_t index, Placement& next, Assembly& assembly) {
  const Node& node = scene.nodes[index];
  const Mesh& mesh = scene.meshes[node.mesh];
  next.node = index;
  next.mesh = node.mesh;
  assembly.placements.push_back(next);
  copy_vertices(mesh, next.first_vertex, assembly);
  copy_triangles(mesh, next, assembly);
  copy_morphs(mesh, next, assembly);
  copy_influences(mesh, next, is_skinned(scene, node), assembly);
  assembly.has_tangents = assembly.has_tangents || !mesh.tangents.empty();
  next.first_vertex += static_cast<uint32_t>(mesh.positions.size());
  next.first_triangle += static_cast<uint32_t>(mesh.triangles.size());
  next.first_weight += static_cast<uint32_t>(mesh.targets.size());
  next.first_matrix += static_cast<uint32_t>(matrices_of(scene, node));
}

Assembly assemble(const Scene& scene, const Division& division) {
  const Totals totals = count(scene, division);
  require_room(scene, totals);
  Assembly assembly = allocate(totals);
  Placement next;
  for (const ObjectNodes& nodes : division.objects) {
    Object object;
    object.rigid = nodes.rigid;
    object.first_placement = static_cast<uint32_t>(assembly.placements.size());
    object.first_vertex = next.first_vertex;
    object.first_triangle = next.first_triangle;
    next.rigid = nodes.rigid ? 1 : 0;
    for (const uint32_t node : nodes.nodes) add_placement(scene, node, next, assembly);
    object.placements = static_cast<uint32_t>(assembly.placements.size()) - object.first_placement;
    object.vertices = next.first_vertex - object.first_vertex;
    object.triangles = next.first_triangle - object.first_triangle;
    assembly.objects.push_back(object);
  }
  assembly.instances = division.instances;
  assembly.weight_count = next.first_weight;
  assembly.matrix_count = next.first_matrix;
  return assembly;
}

}  // namespace

Assembly assemble(const Scene& scene, Instancing instancing) {
  return assemble(scene, divide(scene, instancing));
}

Assembly assemble_object(const Scene& scene, const Assembly& assembly, size_t index) {
  const Object& object = assembly.objects[index];
  Division alone;
  ObjectNodes& nodes = alone.objects.emplace_back();
  nodes.rigid = object.rigid;
  for (uint32_t i = 0; i < object.placements; ++i)
    nodes.nodes.push_back(assembly.placements[object.first_placement + i].node);
  alone.instances.push_back({0, object.rigid ? nodes.nodes.front() : none});
  return assemble(scene, alone);
}

}  // namespace lodestone::scene
