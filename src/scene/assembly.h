// SPDX-License-Identifier: MIT
// A scene as the tracers see it: objects, each with vertices and triangles of its own, and instances, which
// say where they are. A mesh that several nodes place and nothing deforms can be an object once, in its own
// space; all else is one object in the world, where every node that places a mesh is a placement with
// vertices of its own. All objects stand in one run of vertices and one of triangles. Static: computed once,
// uploaded once. What changes by the frame is small: the morph weights, the matrices of what deforms, and
// those of the instances (`frame_weights`, `frame_matrices`, `frame_instances`).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/scene/instancing.h"
#include "lodestone/scene/pose.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene {

struct Placement {
  uint32_t node = 0, mesh = 0;
  uint32_t first_vertex = 0, first_triangle = 0;
  uint32_t first_weight = 0;  // in the frame's weights: one a target of the mesh
  uint32_t first_matrix = 0;  // in the frame's matrices: one a joint, or one
  uint32_t rigid = 0;         // 1: in the mesh's own space; `node` is that of the first instance
};

// Runs of placements, vertices and triangles. Rigid objects come first, in the order of their meshes.
struct Object {
  uint32_t first_placement = 0, placements = 0;
  uint32_t first_vertex = 0, vertices = 0;
  uint32_t first_triangle = 0, triangles = 0;
  bool rigid = false;  // nothing deforms it; else it is in the world
};

// The material and the numbering of a run of triangles (Mesh part of a placement).
struct AssemblyPart {
  uint32_t material = none;
  uint32_t mesh = 0;                 // index in the file
  uint32_t first_triangle = 0;       // in the assembly
  uint32_t first_mesh_triangle = 0;  // the same triangle's index within its mesh
};

// A morph delta of one vertex: `weight` indexes the frame's weights.
struct MorphEntry {
  uint32_t weight = 0;
  glm::vec3 position{0}, normal{0}, tangent{0};
};

struct MatrixInfluence {
  uint32_t matrix = 0;  // in the frame's matrices
  float weight = 1;
};

struct Assembly {
  std::vector<Placement> placements;  // in node order within an object
  std::vector<Object> objects;        // at least one
  std::vector<Instance> instances;    // of every object; those of rigid ones in node order, then the world's
  std::vector<AssemblyPart> parts;
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;  // xyz 0 where the mesh has none
  std::vector<glm::vec2> texcoords[2];
  std::vector<uint32_t> colors;           // layout::unpack_vertex_color; 0xffffffff where the mesh has none
  std::vector<uint32_t> first_morph;      // vertex v has morphs[first_morph[v] .. first_morph[v + 1])
  std::vector<MorphEntry> morphs;         // ascending weight index within a vertex
  std::vector<uint32_t> first_influence;  // as above; at least one a vertex
  std::vector<MatrixInfluence> influences;
  std::vector<glm::uvec4> triangles;  // three vertices and the part
  uint32_t weight_count = 0, matrix_count = 0;
  bool has_tangents = false;
  // Whether some of it is traced through instances, and not all of it as one object in the world.
  bool has_instances() const { return objects.size() > 1 || (!objects.empty() && objects.front().rigid); }
};

// Throws Error(bad_input) where the scene draws no triangle or more than 2^28 of them (of an object that is
// placed many times they count once), Error(machine) where the memory would not hold them.
Assembly assemble(const Scene& scene, Instancing instancing = Instancing::off);
// One of its objects alone.
Assembly assemble_object(const Scene& scene, const Assembly& assembly, size_t object);

std::vector<float> frame_weights(const Scene& scene, const Assembly& assembly, const Pose& pose);
// Rows of 3 x 4 matrices: row r of matrix m is element 3 * m + r. Those of rigid objects change nothing.
std::vector<glm::vec4> frame_matrices(const Scene& scene, const Assembly& assembly, const Pose& pose);
// Where each instance puts its object.
std::vector<glm::mat4> frame_instances(const Assembly& assembly, const Pose& pose);

// Positions at a pose, of rigid objects in their own space, of the others in the world, evaluated on the CPU
// in the order and precision of the `blend` pass.
std::vector<glm::vec3> blended_positions(const Assembly& assembly, const std::vector<float>& weights,
                                         const std::vector<glm::vec4>& matrices);
// The same in the rest pose: no animation, the scene's own weights.
std::vector<glm::vec3> rest_positions(const Scene& scene, const Assembly& assembly);
// The same with rigid objects where their first instances are.
std::vector<glm::vec3> placed_positions(const Scene& scene, const Assembly& assembly, const Pose& pose);
// And the normals, of length 1.
std::vector<glm::vec3> blended_normals(const Assembly& assembly, const std::vector<float>& weights,
                                       const std::vector<glm::vec4>& matrices);

}  // namespace lodestone::scene
