// SPDX-License-Identifier: MIT
// An atlas in portions, each small enough to be on a device by itself: for scenes that are larger than its
// memory. A portion is a scene of its own: some of the charts, or a rectangle of one, with the vertices and
// triangles that their texels sample, and a hierarchy over their quads. What a ray hits in a portion is what
// it would hit in the whole (layout/trace.h defines hits by quads alone), and texels are in the same order,
// so that of equal hits the same one counts.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

// A rectangle of texels of a chart.
struct ChartPiece {
  uint32_t chart = 0;
  uint32_t x = 0, y = 0, width = 0, height = 0;  // in texels; neighbours share a column or a row

  uint64_t quads() const { return uint64_t(width - 1) * (height - 1); }
};

// Texels that follow one another in the portion and in the whole.
struct TexelRun {
  uint32_t local = 0, whole = 0;  // the first one
};

struct Portion {
  // Of one object, without placements and parts; weights and matrices are the whole's.
  scene::Assembly assembly;
  Atlas atlas;
  std::vector<uint32_t> triangles;  // the numbers that they have in the whole
  std::vector<TexelRun> runs;       // ascending, in both
};

// Portions of at most `quads` quads (at least least_portion), charts that are near in the hierarchy together;
// no portion has two pieces of one chart. The atlas must be of one object.
inline constexpr uint64_t least_portion = 64;
std::vector<std::vector<ChartPiece>> plan_portions(const Atlas& atlas, uint64_t quads);

class PortionMaker {
 public:
  // Both must outlive it. `name` of the scene, for messages.
  PortionMaker(const scene::Assembly& assembly, const Atlas& atlas, std::string name);

  // `positions`: of all vertices in some pose, by which charts are put in order. Not from several threads.
  Portion make(std::span<const ChartPiece> pieces, const std::vector<glm::vec3>& positions);

 private:
  uint32_t local_triangle(uint32_t triangle, Portion& portion);
  void add_charts(std::span<const ChartPiece> pieces, Portion& portion);
  void add_vertices(Portion& portion, std::vector<glm::vec3>& local_positions,
                    const std::vector<glm::vec3>& positions);

  const scene::Assembly& assembly_;
  const Atlas& atlas_;
  std::string name_;
  // Of what is in the portion that is being made, the number there.
  std::vector<uint32_t> local_triangles_, local_vertices_;
};

// Round all that the texels of a portion may be when the vertices are at `positions`, but for rounding.
scene::Bounds portion_bounds(const scene::Assembly& assembly, const Atlas& atlas,
                             std::span<const ChartPiece> pieces, const std::vector<glm::vec3>& positions);

}  // namespace lodestone::geometry_image
