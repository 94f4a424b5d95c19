// SPDX-License-Identifier: MIT
// Nodes, the default scene (3.5), skins (3.7.3) and EXT_mesh_gpu_instancing.
#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <optional>
#include <utility>

#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/gltf_convert.h"

namespace lodestone::scene {
namespace {

class NodeConverter {
 public:
  NodeConverter(const AccessorReader& reader, Scene& scene)
      : reader_(reader), model_(reader.model()), scene_(scene) {}

  std::vector<uint32_t> convert() {
    find_parents();
    order_nodes();
    find_drawn();
    for (uint32_t from : order_) scene_.nodes.push_back(convert_node(from));
    for (size_t i = 0; i < model_.skins.size(); ++i) scene_.skins.push_back(convert_skin(i));
    for (size_t i = 0; i < order_.size(); ++i) match_skin(scene_.nodes[i], label(order_[i]));
    for (size_t i = 0; i < order_.size(); ++i) add_instances(uint32_t(i), order_[i]);
    return std::move(node_of_);
  }

 private:
  std::string label(uint32_t node) const { return gltf_label("node", node, model_.nodes[node].name); }

  uint32_t node_index(int index, const std::string& use) const {
    const uint32_t node = gltf_index(reader_, index, model_.nodes.size(), use);
    if (node == none) fail_input(reader_.file(), "{} {} does not exist; export it again", use, index);
    return node;
  }

  void find_parents() {
    parent_.assign(model_.nodes.size(), none);
    for (uint32_t node = 0; node < parent_.size(); ++node) {
      for (int index : model_.nodes[node].children) {
        const uint32_t child = node_index(index, label(node) + ", child");
        if (parent_[child] != none) {
          fail_input(reader_.file(), "{}: is a child of nodes {} and {}; export it again", label(child),
                     parent_[child], node);
        }
        parent_[child] = node;
      }
    }
  }

  // Depth first from the roots. Every node has one parent at most, so those that no root leads to lie on a
  // cycle or below one.
  void order_nodes() {
    node_of_.assign(model_.nodes.size(), none);
    std::vector<uint32_t> open;
    for (uint32_t root = uint32_t(parent_.size()); root-- > 0;) {
      if (parent_[root] == none) open.push_back(root);
    }
    while (!open.empty()) {
      const uint32_t node = open.back();
      open.pop_back();
      node_of_[node] = uint32_t(order_.size());
      order_.push_back(node);
      const std::vector<int>& children = model_.nodes[node].children;
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        open.push_back(uint32_t(*child));
    }
    for (uint32_t node = 0; node < node_of_.size(); ++node) {
      if (node_of_[node] == none) {
        fail_input(reader_.file(), "{}: is its own ancestor; export it again", label(node));
      }
    }
  }

  // A file without scenes draws all its nodes; one with scenes but without a default one, the first of them.
  void find_drawn() {
    drawn_.assign(model_.nodes.size(), model_.scenes.empty());
    if (model_.scenes.empty()) {
      gltf_index(reader_, model_.defaultScene, 0, "default scene");
      return;
    }
    const uint32_t given = gltf_index(reader_, model_.defaultScene, model_.scenes.size(), "default scene");
    const tinygltf::Scene& scene = model_.scenes[given == none ? 0 : given];
    for (int root : scene.nodes) drawn_[node_index(root, "root node")] = true;
    for (uint32_t node : order_) {
      if (parent_[node] != none && drawn_[parent_[node]]) drawn_[node] = true;
    }
  }

  Node convert_node(uint32_t index) {
    const tinygltf::Node& from = model_.nodes[index];
    Node to;
    to.name = from.name;
    to.parent = parent_[index] == none ? none : node_of_[parent_[index]];
    set_transform(index, to);
    const uint32_t mesh = gltf_index(reader_, from.mesh, scene_.meshes.size(), label(index) + ", mesh");
    const uint32_t camera =
        gltf_index(reader_, from.camera, scene_.cameras.size(), label(index) + ", camera");
    const uint32_t skin = gltf_index(reader_, from.skin, model_.skins.size(), label(index) + ", skin");
    const uint32_t light = light_of(index);
    const std::vector<float> weights = gltf_floats(reader_, from.weights, label(index) + ", weights");
    if (!drawn_[index]) return to;
    to.camera = camera;
    to.light = light;
    if (mesh == none || scene_.meshes[mesh].triangles.empty()) return to;
    to.mesh = mesh;
    to.skin = skin;
    to.weights = weights;
    reader_.charge(scene_.meshes[mesh].targets.size(), sizeof(float),
                   label(index) + ", weights");  // of every pose
    if (!weights.empty() && weights.size() != scene_.meshes[mesh].targets.size()) {
      fail_input(reader_.file(), "{}: {} weights for {} morph targets; export it again", label(index),
                 weights.size(), scene_.meshes[mesh].targets.size());
    }
    return to;
  }

  void set_transform(uint32_t index, Node& to) const {
    const tinygltf::Node& from = model_.nodes[index];
    const auto numbers = [&](const std::vector<double>& values, size_t count, const char* name) {
      const std::string use = label(index) + ", " + name;
      if (!values.empty() && values.size() != count) {
        fail_input(reader_.file(), "{}: {} numbers instead of {}; export it again", use, values.size(),
                   count);
      }
      return gltf_floats(reader_, values, use);
    };
    const std::vector<float> matrix = numbers(from.matrix, 16, "matrix");
    if (!matrix.empty()) to.matrix = glm::make_mat4(matrix.data());
    const std::vector<float> t = numbers(from.translation, 3, "translation");
    if (!t.empty()) to.translation = {t[0], t[1], t[2]};
    const std::vector<float> s = numbers(from.scale, 3, "scale");
    if (!s.empty()) to.scale = {s[0], s[1], s[2]};
    const std::vector<float> r = numbers(from.rotation, 4, "rotation");
    if (r.empty()) return;
    const glm::dquat q(r[3], r[0], r[1], r[2]);
    const double length = glm::length(q);
    if (!(length > 0))
      fail_input(reader_.file(), "{}: a rotation of length 0; export it again", label(index));
    to.rotation = glm::quat(q / length);
  }

  // EXT_mesh_gpu_instancing: the node places its mesh by a transform for each instance, all below its own;
  // here each is a child.
  void add_instances(uint32_t node, uint32_t index) {
    const auto extension = model_.nodes[index].extensions.find("EXT_mesh_gpu_instancing");
    if (extension == model_.nodes[index].extensions.end() || scene_.nodes[node].mesh == none) return;
    const std::string use = label(index) + ", instances";
    const tinygltf::Value* attributes = gltf_member(extension->second, "attributes");
    const auto accessor_of = [&](const char* name) {
      const tinygltf::Value* accessor = attributes == nullptr ? nullptr : gltf_member(*attributes, name);
      return accessor != nullptr && accessor->IsInt() ? accessor->Get<int>() : -1;
    };
    const int translation = accessor_of("TRANSLATION"), rotation = accessor_of("ROTATION"),
              scale = accessor_of("SCALE");
    std::optional<size_t> count;
    for (const int accessor : {translation, rotation, scale}) {
      if (accessor < 0) continue;
      const size_t elements = reader_.count(accessor, use);
      if (count && *count != elements)
        fail_input(reader_.file(), "{}: {} and {} elements of one instance each; export it again", use,
                   *count, elements);
      count = elements;
    }
    if (!count)
      fail_input(reader_.file(), "{}: have no TRANSLATION, ROTATION or SCALE; export it again", use);
    if (scene_.nodes[node].skin != none)
      fail_input(reader_.file(), "{}: of a mesh with a skin; export it without instances", use);
    reader_.charge(*count, sizeof(Node), use);
    Node instance;
    instance.parent = node;
    instance.mesh = std::exchange(scene_.nodes[node].mesh, none);
    instance.weights = std::exchange(scene_.nodes[node].weights, {});
    const auto first = scene_.nodes.size();
    scene_.nodes.resize(first + *count, instance);
    if (translation >= 0) {
      const std::vector<glm::vec3> values = reader_.vec3s(translation, use + ", TRANSLATION");
      for (size_t i = 0; i < *count; ++i) scene_.nodes[first + i].translation = values[i];
    }
    if (scale >= 0) {
      const std::vector<glm::vec3> values = reader_.vec3s(scale, use + ", SCALE");
      for (size_t i = 0; i < *count; ++i) scene_.nodes[first + i].scale = values[i];
    }
    if (rotation < 0) return;
    const std::vector<glm::vec4> values = reader_.vec4s(rotation, use + ", ROTATION");
    for (size_t i = 0; i < *count; ++i) {
      const glm::vec4& r = values[i];
      const float length = glm::length(r);
      if (!(length > 0))
        fail_input(reader_.file(), "{}: instance {} has a rotation of length 0; export it again", use, i);
      scene_.nodes[first + i].rotation = glm::normalize(glm::quat(r.w, r.x, r.y, r.z));
    }
  }

  uint32_t light_of(uint32_t index) const {
    const auto extension = model_.nodes[index].extensions.find("KHR_lights_punctual");
    if (extension == model_.nodes[index].extensions.end()) return none;
    const tinygltf::Value* light = gltf_member(extension->second, "light");
    if (light == nullptr || !light->IsInt()) return none;
    return gltf_index(reader_, light->Get<int>(), scene_.lights.size(), label(index) + ", light");
  }

  Skin convert_skin(size_t index) const {
    const tinygltf::Skin& from = model_.skins[index];
    const std::string use = gltf_label("skin", index, from.name);
    Skin to;
    to.name = from.name;
    for (int joint : from.joints) to.joints.push_back(node_of_[node_index(joint, use + ", joint")]);
    if (to.joints.empty()) fail_input(reader_.file(), "{}: has no joints; export it again", use);
    node_index(from.skeleton < 0 ? from.joints[0] : from.skeleton, use + ", skeleton");
    if (from.inverseBindMatrices < 0) {
      to.inverse_binds.assign(to.joints.size(), glm::mat4(1));
      return to;
    }
    to.inverse_binds = reader_.mat4s(from.inverseBindMatrices, use + ", inverseBindMatrices");
    if (to.inverse_binds.size() < to.joints.size()) {
      fail_input(reader_.file(), "{}: {} inverse bind matrices for {} joints; export it again", use,
                 to.inverse_binds.size(), to.joints.size());
    }
    to.inverse_binds.resize(to.joints.size());
    return to;
  }

  // A Scene has a skin on a node exactly where its mesh has influences; glTF lets each stand alone.
  void match_skin(Node& node, const std::string& use) {
    if (node.mesh == none) return;
    const bool has_influences = !scene_.meshes[node.mesh].first_influence.empty();
    if (node.skin != none && !has_influences) {
      log::warn_once(
          reader_.file() + " skin without joints",
          fmt::format("{}: {}: its mesh has no JOINTS_0; its skin is ignored", reader_.file(), use));
      node.skin = none;
    } else if (node.skin == none && has_influences) {
      node.mesh = rigid_copy(node.mesh);
    }
    if (node.skin == none) return;
    const size_t joints = scene_.skins[node.skin].joints.size();
    if (last_joint(node.mesh) >= joints) {
      fail_input(reader_.file(), "{}: its mesh follows joint {} of {}; export it again", use,
                 last_joint(node.mesh), joints);
    }
    reader_.charge(joints, sizeof(glm::mat4), use + ", joints");  // of every pose
  }

  // The highest joint that a mesh follows; looked up once, as many nodes may share a mesh.
  uint32_t last_joint(uint32_t mesh) {
    const auto [known, is_new] = last_joints_.emplace(mesh, 0);
    if (is_new) {
      for (const Influence& i : scene_.meshes[mesh].influences)
        known->second = std::max(known->second, i.joint);
    }
    return known->second;
  }

  // The mesh without its influences: itself where no node needs them, else a copy.
  uint32_t rigid_copy(uint32_t mesh) {
    const auto [known, is_new] = rigid_copies_.emplace(mesh, mesh);
    if (!is_new) return known->second;
    bool skinned_elsewhere = false;
    for (const Node& node : scene_.nodes) skinned_elsewhere |= node.mesh == mesh && node.skin != none;
    if (skinned_elsewhere) {
      known->second = uint32_t(scene_.meshes.size());
      scene_.meshes.push_back(scene_.meshes[mesh]);
    }
    scene_.meshes[known->second].first_influence.clear();
    scene_.meshes[known->second].influences.clear();
    return known->second;
  }

  const AccessorReader& reader_;
  const tinygltf::Model& model_;
  Scene& scene_;
  std::vector<uint32_t> parent_;   // by index in the file
  std::vector<uint32_t> order_;    // file's indices, parents first
  std::vector<uint32_t> node_of_;  // by index in the file, index in the scene
  std::vector<char> drawn_;        // by index in the file
  std::map<uint32_t, uint32_t> rigid_copies_, last_joints_;
};

}  // namespace

std::vector<uint32_t> convert_nodes(const AccessorReader& reader, Scene& scene) {
  return NodeConverter(reader, scene).convert();
}

}  // namespace lodestone::scene
