// SPDX-License-Identifier: MIT
// Nodes, lights and keys: the staging that the built-in scenes have in common.
#pragma once

#include <string>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene::builtin {

// Each returns the index of the new node.
uint32_t add_node(Scene& scene, Node node);
uint32_t add_mesh(Scene& scene, Mesh mesh, uint32_t parent = none, glm::vec3 translation = glm::vec3(0),
                  glm::vec3 scale = glm::vec3(1));
// At `eye`, looking at `target`, +Y up.
uint32_t add_camera(Scene& scene, Camera camera, glm::vec3 eye, glm::vec3 target);
uint32_t add_light(Scene& scene, Light light, glm::vec3 eye, glm::vec3 target);
// A dielectric of one colour; returns the index of the material.
uint32_t add_material(Scene& scene, const std::string& name, glm::vec3 color, float roughness,
                      float metallic = 0);

// A weights channel of `node`: at times[k] the weights keys[k], one a target.
Channel weight_keys(uint32_t node, Channel::Interpolation interpolation, const std::vector<float>& times,
                    const std::vector<std::vector<float>>& keys);

}  // namespace lodestone::scene::builtin
