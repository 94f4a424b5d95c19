// SPDX-License-Identifier: MIT
// A scene at one moment: everything that the host uploads for a frame.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

struct Pose {
  std::vector<glm::mat4> node_world;  // one a node
  std::vector<std::vector<float>>
      weights;  // one a node: its mesh's morph weights; empty without a mesh or targets
};

// Finds a clip by name (exact, then case-insensitive) or by number. Throws Error(usage) listing the clips of
// the scene. An empty name gives the first clip, or `none` where the scene has no animation.
uint32_t find_animation(const Scene& scene, const std::string& name);

// The pose at `time` seconds of animation `animation` (`none`: the rest pose). Time is clamped to each
// channel's keys; callers that loop wrap it themselves. All three interpolations; rotations slerp along the
// shorter arc. Throws Error(bad_input) where a node's world matrix or weights overflow.
Pose evaluate(const Scene& scene, uint32_t animation, float time);

// Sets the morph weights called `NAME` on every mesh that has a target of that name (`--weights NAME=X`; a
// number is a target index of every mesh). Throws Error(usage) naming the known targets where nothing has it.
void override_weights(const Scene& scene, const std::map<std::string, float>& weights, Pose& pose);

// The matrices that take a vertex of node n's mesh to the world: for a mesh with a skin one a joint
// (world of joint x inverse bind), else one, the node's world matrix.
std::vector<glm::mat4> palette(const Scene& scene, const Pose& pose, uint32_t node);

struct Bounds {
  glm::vec3 lo{0}, hi{0};
  bool empty = true;
  void include(const glm::vec3& point);
  void include(const Bounds& other);
};

// World bounds of all meshes, from vertices morphed and skinned on the CPU; multi-threaded. Vertices that no
// triangle has do not count. Throws Error(bad_input) where a vertex overflows.
Bounds pose_bounds(const Scene& scene, const Pose& pose);

}  // namespace lodestone::scene
