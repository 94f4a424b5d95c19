// SPDX-License-Identifier: MIT
// Embree on given triangles: ground truth (robust mode), and the speed to beat.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "lodestone/test_support/rays.h"

namespace lodestone::test {

enum class EmbreeBuild { static_scene, dynamic_low_quality, dynamic_refit };

struct EmbreeHit {
  float t, u, v;
  uint32_t triangle;  // 0xffffffff: a miss
};

class EmbreeScene {
 public:
  EmbreeScene(const std::vector<glm::vec3>& points, const std::vector<glm::uvec3>& triangles, bool robust,
              EmbreeBuild build = EmbreeBuild::static_scene);
  ~EmbreeScene();

  // rtcIntersect1 on all cores.
  void intersect(const Rays& rays, std::vector<EmbreeHit>& hits) const;
  // New positions in place of the old; rebuilds or refits as the build says.
  void update(const std::vector<glm::vec3>& points);
  // The same without copying: marks the positions as changed and commits.
  void recommit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lodestone::test
