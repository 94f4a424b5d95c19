// SPDX-License-Identifier: MIT
// The leak check: a ray that starts inside a closed mesh hits it, whatever it is aimed at.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/render/renderer.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {

struct LeakReport {
  uint64_t rays = 0, leaks = 0;
  uint32_t origins = 0;               // points inside
  glm::vec3 origin{0}, direction{0};  // of the first leak
};

// Points inside the closed surface of the texels' triangles, found by its winding number (solid angles summed
// in double precision; van Oosterom and Strackee 1983): at least 0.99 turns, so also well clear of the
// surface.
std::vector<glm::vec3> points_inside(const std::vector<glm::vec3>& texels, const QuadTriangles& quads,
                                     uint32_t count, uint32_t seed);

// Traces `count` rays from `origins`: a third at corners of quads, a third at points on their edges and
// diagonals (those on chart borders among them), the rest anywhere; each target is used by several origins.
LeakReport check_leaks(render::Renderer& renderer, const std::vector<glm::vec3>& texels,
                       const QuadTriangles& quads, const std::vector<glm::vec3>& origins, uint64_t count,
                       uint32_t seed);

}  // namespace lodestone::test
