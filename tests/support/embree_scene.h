// SPDX-License-Identifier: MIT
// Embree on given triangles: ground truth (robust mode), and the speed to beat.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/test_support/rays.h"

namespace lodestone::test {

enum class EmbreeBuild { static_scene, dynamic_low_quality, dynamic_refit };

// How the quads of an atlas are given to Embree: two triangles each, as quads, or a grid a chart.
enum class EmbreeShape { triangles, quads, grids };

// rtcIntersect1, rtcIntersect8, or rtcIntersect1M with the flag that says that the rays are coherent.
enum class EmbreeCall { one, eight, stream };
const char* to_string(EmbreeShape shape);
const char* to_string(EmbreeCall call);

struct EmbreeHit {
  float t, u, v;
  uint32_t triangle;  // 0xffffffff: a miss
};

class EmbreeScene {
 public:
  EmbreeScene(const std::vector<glm::vec3>& points, const std::vector<glm::uvec3>& triangles, bool robust,
              EmbreeBuild build = EmbreeBuild::static_scene);
  // The quads of an atlas, `points` its texels. Throws std::invalid_argument where a chart is too large for a
  // grid.
  EmbreeScene(const std::vector<glm::vec3>& points, const geometry_image::Atlas& atlas, EmbreeShape shape,
              EmbreeBuild build = EmbreeBuild::static_scene);
  ~EmbreeScene();

  // On all cores.
  void intersect(const Rays& rays, std::vector<EmbreeHit>& hits, EmbreeCall call = EmbreeCall::one) const;
  // New positions in place of the old; rebuilds or refits as the build says.
  void update(const std::vector<glm::vec3>& points);
  // The same without copying: marks the positions as changed and commits.
  void recommit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lodestone::test
