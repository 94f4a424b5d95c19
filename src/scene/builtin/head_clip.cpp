// SPDX-License-Identifier: MIT
#include "lodestone/scene/builtin/head_clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <string_view>

#include "lodestone/scene/builtin/staging.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float duration = 2;
constexpr int keys_per_second = 24;

struct Key {
  float time, value;
};
// What one thing does over time. Before the first key and after the last it rests at 0.
struct Track {
  const char* name;
  std::vector<Key> keys;
};

// Eyes blink, the face is surprised, says a word, grins and winks.
const std::vector<Track>& weight_tracks() {
  static const std::vector<Track> tracks = {
      {"blinkLeft",
       {{0.10f, 0}, {0.18f, 1}, {0.22f, 1}, {0.34f, 0}, {1.46f, 0}, {1.56f, 1}, {1.66f, 1}, {1.80f, 0}}},
      {"blinkRight", {{0.10f, 0}, {0.18f, 1}, {0.22f, 1}, {0.34f, 0}}},
      {"surprise", {{0.26f, 0}, {0.42f, 1}, {0.58f, 0.95f}, {0.72f, 0}}},
      {"browUp", {{0.70f, 0}, {0.85f, 0.4f}, {1.10f, 0.25f}, {1.30f, 0.5f}, {1.50f, 0}}},
      {"browDown", {{1.46f, 0}, {1.58f, 0.25f}, {1.68f, 0.25f}, {1.84f, 0}}},
      {"lookLeft", {{0.66f, 0}, {0.76f, 0.7f}, {1.00f, 0.7f}, {1.10f, 0}}},
      {"lookUp", {{0.66f, 0}, {0.76f, 0.4f}, {1.00f, 0.4f}, {1.10f, 0}}},
      {"pucker", {{0.70f, 0}, {0.80f, 0.8f}, {0.90f, 0.1f}, {1.00f, 0.5f}, {1.08f, 0}}},
      {"jawOpen",
       {{0.76f, 0},
        {0.88f, 0.42f},
        {0.97f, 0.15f},
        {1.06f, 0.5f},
        {1.16f, 0.10f},
        {1.30f, 0.28f},
        {1.62f, 0.28f},
        {1.86f, 0}}},
      {"smile", {{1.00f, 0}, {1.30f, 0.35f}, {1.66f, 0.40f}, {1.94f, 0}}},
      {"grin", {{1.10f, 0}, {1.34f, 0.9f}, {1.64f, 0.9f}, {1.90f, 0}}},
  };
  return tracks;
}

// Radians: nod (chin down), turn (to its left), tilt (to its right).
const std::array<Track, 3>& turn_tracks() {
  static const std::array<Track, 3> tracks = {{
      {"nod",
       {{0.05f, 0},
        {0.20f, 0.06f},
        {0.44f, -0.08f},
        {0.60f, -0.07f},
        {0.90f, 0.03f},
        {1.35f, 0.06f},
        {1.60f, 0.04f},
        {2.0f, 0}}},
      {"turn", {{0.60f, 0}, {0.80f, 0.10f}, {1.02f, 0.10f}, {1.30f, 0}}},
      {"tilt", {{1.25f, 0}, {1.50f, 0.10f}, {1.66f, 0.10f}, {2.0f, 0}}},
  }};
  return tracks;
}

// Eases from key to key, at rest in each.
float value_at(const Track& track, float time) {
  if (time <= track.keys.front().time || time >= track.keys.back().time) return 0;
  size_t k = 1;
  while (time > track.keys[k].time) ++k;
  const Key &a = track.keys[k - 1], &b = track.keys[k];
  return glm::mix(a.value, b.value, glm::smoothstep(a.time, b.time, time));
}

std::vector<float> key_times() {
  std::vector<float> times;
  for (int k = 0; k <= int(duration) * keys_per_second; ++k)
    times.push_back(snap(float(k) / keys_per_second));
  return times;
}

Channel weights_channel(const Mesh& mesh, uint32_t node) {
  const std::vector<float> times = key_times();
  std::vector<std::vector<float>> keys;
  for (const float time : times) {
    std::vector<float> key;
    for (const MorphTarget& target : mesh.targets) {
      const auto track = std::find_if(weight_tracks().begin(), weight_tracks().end(), [&](const Track& t) {
        return t.name == std::string_view(target.name);
      });
      key.push_back(track == weight_tracks().end() ? 0.0f : snap(value_at(*track, time)));
    }
    keys.push_back(std::move(key));
  }
  return weight_keys(node, Channel::Interpolation::linear, times, keys);
}

Channel turn_channel(uint32_t node) {
  Channel channel;
  channel.node = node;
  channel.path = Channel::Path::rotation;
  channel.times = key_times();
  for (const float time : channel.times) {
    const glm::quat nod = glm::angleAxis(value_at(turn_tracks()[0], time), glm::vec3(1, 0, 0));
    const glm::quat turn = glm::angleAxis(value_at(turn_tracks()[1], time), glm::vec3(0, 1, 0));
    const glm::quat tilt = glm::angleAxis(value_at(turn_tracks()[2], time), glm::vec3(0, 0, 1));
    const glm::quat q = turn * nod * tilt;
    for (const float component : {q.x, q.y, q.z, q.w}) channel.values.push_back(snap(component));
  }
  return channel;
}

}  // namespace

Animation expressions_clip(const Scene& scene, uint32_t head_node) {
  Animation animation;
  animation.name = "Expressions";
  for (uint32_t n = 0; n < scene.nodes.size(); ++n) {
    const uint32_t mesh = scene.nodes[n].mesh;
    if (mesh != none && !scene.meshes[mesh].targets.empty())
      animation.channels.push_back(weights_channel(scene.meshes[mesh], n));
  }
  animation.channels.push_back(turn_channel(head_node));
  return animation;
}

}  // namespace lodestone::scene::builtin
