// SPDX-License-Identifier: MIT
// Small scenes for the tests of the assembly.
#pragma once

#include <random>
#include <string>

#include "lodestone/scene/scene.h"

namespace lodestone::scene::test {

// Triangles (0, 1, 2), (1, 2, 3), ... of one part over `vertices` vertices at (i, i + 0.25, -i).
inline Mesh strip(uint32_t vertices) {
  Mesh mesh;
  mesh.name = "strip";
  for (uint32_t i = 0; i < vertices; ++i) {
    const auto x = float(i);
    mesh.positions.emplace_back(x, x + 0.25f, -x);
    mesh.normals.emplace_back(0, 0, 1);
    if (i >= 2) mesh.triangles.emplace_back(i - 2, i - 1, i);
  }
  mesh.parts.push_back({0, static_cast<uint32_t>(mesh.triangles.size()), none});
  return mesh;
}

inline Scene scene_of(std::vector<Mesh> meshes) {
  Scene scene;
  scene.name = "test";
  scene.meshes = std::move(meshes);
  for (uint32_t i = 0; i < scene.meshes.size(); ++i) {
    scene.nodes.emplace_back();
    scene.nodes.back().mesh = i;
  }
  return scene;
}

// A strip of `vertices` vertices with random positions, `targets` random sparse targets, and a skin of
// `joints` joints (none: no skin), one to four of them a vertex. Node 0 places it; the joints are the nodes
// behind it.
inline Scene random_character(uint32_t seed, uint32_t vertices, uint32_t targets, uint32_t joints) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(-2.0f, 2.0f);
  const auto vector = [&] { return glm::vec3(number(random), number(random), number(random)); };
  Mesh mesh = strip(vertices);
  for (glm::vec3& p : mesh.positions) p = vector();
  for (uint32_t t = 0; t < targets; ++t) {
    MorphTarget target;
    target.name = "target" + std::to_string(t);
    for (uint32_t v = 0; v < vertices; ++v) {
      if (random() % 3 != 0) continue;
      target.vertices.push_back(v);
      target.positions.push_back(vector());
      target.normals.push_back(vector());
    }
    mesh.targets.push_back(target);
    mesh.weights.push_back(number(random));
  }
  Scene scene = scene_of({});
  scene.nodes.emplace_back();
  scene.nodes[0].mesh = 0;
  scene.nodes[0].rotation = glm::normalize(glm::quat(number(random), number(random), number(random), 1));
  scene.nodes[0].translation = vector();
  if (joints > 0) {
    Skin skin;
    for (uint32_t j = 0; j < joints; ++j) {
      Node node;
      node.translation = vector();
      node.scale = vector();
      skin.joints.push_back(static_cast<uint32_t>(scene.nodes.size()));
      skin.inverse_binds.emplace_back(number(random));
      scene.nodes.push_back(node);
    }
    scene.skins.push_back(skin);
    scene.nodes[0].skin = 0;
    mesh.first_influence.push_back(0);
    for (uint32_t v = 0; v < vertices; ++v) {
      const uint32_t count = 1 + random() % 4;
      for (uint32_t i = 0; i < count; ++i) {
        mesh.influences.push_back({static_cast<uint32_t>(random() % joints), 1.0f / float(count)});
      }
      mesh.first_influence.push_back(static_cast<uint32_t>(mesh.influences.size()));
    }
  }
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

}  // namespace lodestone::scene::test
