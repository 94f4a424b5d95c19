// SPDX-License-Identifier: MIT
#include "lodestone/scene/pose.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "lodestone/base/error.h"
#include "lodestone/base/nearest_name.h"
#include "lodestone/scene/interpolate.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

constexpr size_t max_names_shown = 40;

std::optional<uint32_t> parse_number(const std::string& text) {
  uint32_t number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end) return {};
  return number;
}

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (size_t i = 0; i < std::min(names.size(), max_names_shown); ++i)
    list += (i > 0 ? ", " : "") + shown(names[i]);
  if (names.size() > max_names_shown) list += fmt::format(" and {} more", names.size() - max_names_shown);
  return list;
}

// "it has a, b and c", after what `name` may have been meant for.
std::string choice_of(const std::string& name, const std::vector<std::string>& names) {
  const auto meant = nearest_name(name, names);
  return (meant ? "did you mean '" + shown(*meant) + "'? It has " : "it has ") + list_of(names);
}

glm::mat4 local_matrix(const Node& node, const glm::vec3& translation, const glm::quat& rotation,
                       const glm::vec3& scale) {
  if (node.matrix) return *node.matrix;
  glm::mat4 m = glm::mat4_cast(rotation);
  m[0] *= scale.x;
  m[1] *= scale.y;
  m[2] *= scale.z;
  m[3] = glm::vec4(translation, 1);
  return m;
}

bool is_finite(const glm::mat4& m) {
  bool finite = true;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) finite = finite && std::isfinite(m[column][row]);
  }
  return finite;
}

struct LocalTransforms {
  std::vector<glm::vec3> translations, scales;
  std::vector<glm::quat> rotations;
};

void apply_channel(const Channel& channel, float time, LocalTransforms& local, Pose& pose) {
  switch (channel.path) {
    case Channel::Path::translation:
    case Channel::Path::scale: {
      const std::vector<float> v = sample_channel(channel, time, 3);
      auto& moved = channel.path == Channel::Path::scale ? local.scales : local.translations;
      moved[channel.node] = {v[0], v[1], v[2]};
      break;
    }
    case Channel::Path::rotation: {
      const std::vector<float> q = sample_channel(channel, time, 4);
      local.rotations[channel.node] = glm::quat(q[3], q[0], q[1], q[2]);
      break;
    }
    case Channel::Path::weights: {
      std::vector<float>& weights = pose.weights[channel.node];
      weights = sample_channel(channel, time, weights.size());
      break;
    }
  }
}

// Morph target names of all drawn meshes, each once, in order.
std::vector<std::string> target_names(const Scene& scene) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const Mesh& mesh : scene.meshes) {
    for (const MorphTarget& target : mesh.targets) {
      if (seen.insert(target.name).second) names.push_back(target.name);
    }
  }
  return names;
}

// Sets the weights of the targets that `selects(target, its index)`; whether there was one.
template <class Selects>
bool set_weights(const Scene& scene, float value, Pose& pose, const Selects& selects) {
  bool any = false;
  for (size_t n = 0; n < scene.nodes.size(); ++n) {
    if (scene.nodes[n].mesh == none) continue;
    const std::vector<MorphTarget>& targets = scene.meshes[scene.nodes[n].mesh].targets;
    for (size_t i = 0; i < targets.size(); ++i) {
      if (!selects(targets[i], i)) continue;
      pose.weights[n][i] = value;
      any = true;
    }
  }
  return any;
}

}  // namespace

uint32_t find_animation(const Scene& scene, const std::string& name) {
  const std::vector<Animation>& animations = scene.animations;
  if (name.empty()) return animations.empty() ? none : 0;
  for (uint32_t i = 0; i < animations.size(); ++i) {
    if (animations[i].name == name) return i;
  }
  for (uint32_t i = 0; i < animations.size(); ++i) {
    if (equal_ignoring_case(animations[i].name, name)) return i;
  }
  const std::optional<uint32_t> number = parse_number(name);
  if (number && *number < animations.size()) return *number;
  if (animations.empty()) {
    fail(ExitCode::usage, scene.name, "has no animation, so no clip '{}'; leave out --clip", name);
  }
  std::vector<std::string> names;
  for (const Animation& animation : animations) names.push_back(animation.name);
  fail(ExitCode::usage, scene.name, "has no clip '{}'; {} (or 0 to {})", name, choice_of(name, names),
       animations.size() - 1);
}

Pose evaluate(const Scene& scene, uint32_t animation, float time) {
  Pose pose;
  LocalTransforms local;
  pose.weights.resize(scene.nodes.size());
  for (size_t n = 0; n < scene.nodes.size(); ++n) {
    const Node& node = scene.nodes[n];
    local.translations.push_back(node.translation);
    local.rotations.push_back(node.rotation);
    local.scales.push_back(node.scale);
    if (node.mesh != none)
      pose.weights[n] = node.weights.empty() ? scene.meshes[node.mesh].weights : node.weights;
  }
  if (animation != none) {
    for (const Channel& channel : scene.animations.at(animation).channels)
      apply_channel(channel, time, local, pose);
  }
  for (size_t n = 0; n < scene.nodes.size(); ++n) {
    const Node& node = scene.nodes[n];
    glm::mat4 world = local_matrix(node, local.translations[n], local.rotations[n], local.scales[n]);
    if (node.parent != none) world = pose.node_world[node.parent] * world;
    const bool finite_weights = std::all_of(pose.weights[n].begin(), pose.weights[n].end(),
                                            [](float weight) { return std::isfinite(weight); });
    if (!is_finite(world) || !finite_weights) {
      fail_input(scene.name, "node {} '{}' leaves the range of floats at {} s; scale the scene down", n,
                 node.name, time);
    }
    pose.node_world.push_back(world);
  }
  return pose;
}

void override_weights(const Scene& scene, const std::map<std::string, float>& weights, Pose& pose) {
  for (const auto& [name, value] : weights) {
    if (!std::isfinite(value)) fail(ExitCode::usage, "--weights", "'{}' is not a finite number", name);
    const auto by_name = [&name = name](const MorphTarget& target, size_t) { return target.name == name; };
    if (set_weights(scene, value, pose, by_name)) continue;
    const std::optional<uint32_t> number = parse_number(name);
    const auto by_number = [&number](const MorphTarget&, size_t i) { return i == *number; };
    if (number && set_weights(scene, value, pose, by_number)) continue;
    const std::vector<std::string> names = target_names(scene);
    if (names.empty()) fail(ExitCode::usage, scene.name, "has no morph targets; leave out --weights");
    fail(ExitCode::usage, scene.name, "has no morph target '{}'; {}", name, choice_of(name, names));
  }
}

std::vector<glm::mat4> palette(const Scene& scene, const Pose& pose, uint32_t node) {
  const uint32_t skin_index = scene.nodes.at(node).skin;
  if (skin_index == none) return {pose.node_world.at(node)};
  const Skin& skin = scene.skins[skin_index];
  std::vector<glm::mat4> matrices;
  for (size_t j = 0; j < skin.joints.size(); ++j) {
    matrices.push_back(pose.node_world[skin.joints[j]] * skin.inverse_binds[j]);
  }
  return matrices;
}

}  // namespace lodestone::scene
