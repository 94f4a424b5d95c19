// SPDX-License-Identifier: MIT
// From tinygltf's model to a Scene, a file a kind of thing. All throw Error(bad_input).
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/scene/gltf_accessor.h"
#include "lodestone/scene/gltf_parse.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// "mesh 3 'Head'": how errors and warnings name a thing.
std::string gltf_label(const char* kind, size_t index, const std::string& name);

// `index` as one of `size` things, or `none` where it is negative (absent).
uint32_t gltf_index(const AccessorReader& reader, int index, size_t size, const std::string& use);

// `value` as a finite float.
float gltf_float(const AccessorReader& reader, double value, const std::string& use);
std::vector<float> gltf_floats(const AccessorReader& reader, const std::vector<double>& values,
                               const std::string& use);

// The member `name` of an extension object; null where it has none or is not an object.
const tinygltf::Value* gltf_member(const tinygltf::Value& object, const char* name);

// One Mesh a glTF mesh: the vertices of its primitives one after another (once where primitives share all
// attributes), each primitive a part. Points and lines are skipped.
Mesh convert_mesh(const AccessorReader& reader, size_t index);

// Appends the sparse deltas of a primitive, whose `vertex_count` vertices begin at `first_vertex`.
void append_morph_targets(const AccessorReader& reader, const tinygltf::Primitive& primitive,
                          uint32_t first_vertex, size_t vertex_count, const std::string& where,
                          std::vector<MorphTarget>& targets);

// Appends the skin influences of the vertices of a primitive to `mesh`.
void append_influences(const AccessorReader& reader, const tinygltf::Primitive& primitive,
                       size_t vertex_count, const std::string& where, Mesh& mesh);

std::vector<Material> convert_materials(const AccessorReader& reader, const std::vector<uint32_t>& image_of);

std::vector<Camera> convert_cameras(const AccessorReader& reader);
std::vector<Light> convert_lights(const AccessorReader& reader);

// Fills scene.nodes and scene.skins; scene.meshes, cameras and lights must be there. Nodes are put into an
// order in which parents come first; those outside the default scene stay (joints and parents may be among
// them) but draw nothing. Returns for each node of the file its index in scene.nodes.
std::vector<uint32_t> convert_nodes(const AccessorReader& reader, Scene& scene);

// Fills scene.animations; scene.nodes must be there.
void convert_animations(const AccessorReader& reader, const std::vector<uint32_t>& node_of, Scene& scene);

}  // namespace lodestone::scene
