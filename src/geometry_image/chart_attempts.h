// SPDX-License-Identifier: MIT
// Attempts at an atlas of one base complex within a budget of texels, each of which gives more to charts that
// were too far from the surface before.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/geometry_image/arc_errors.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/chart_errors.h"
#include "lodestone/geometry_image/chart_feedback.h"
#include "lodestone/geometry_image/chart_profile.h"
#include "lodestone/geometry_image/chart_sizes.h"
#include "lodestone/geometry_image/sampled_charts.h"
#include "lodestone/mesh/surface.h"
#include "lodestone/mesh/triangle_tree.h"

namespace lodestone::geometry_image {

// What charts are to be near to. All must outlive what refers to it.
struct Target {
  const std::vector<glm::vec3>& positions;  // of the assembly, in the rest pose
  const mesh::Surface surface;              // the triangles that the complex was made of
  const mesh::TriangleTree& tree;
  double tolerance = 0;  // what is farther is too far
  uint64_t texel_budget = 0;
};

class ChartAttempts {
 public:
  // `source` is of that complex, and so are the profiles and the need to begin with.
  ChartAttempts(std::unique_ptr<const base_complex::BaseComplex> complex, const ChartSource& source,
                std::vector<ChartProfile> profiles, Need need, const Target& target, const OnStage& on_stage);

  // Why cells are to be split: they cannot be mapped, or only unevenly, or are too far from the surface
  // however close their samples are.
  enum class Fault { none, unmappable, uneven, far };
  struct Outcome {
    Fault fault = Fault::none;
    std::vector<uint32_t> cells;  // that have it, ascending
  };
  struct Limits {
    bool even = false;  // refuse what is uneven
    bool near = false;  // do not try long what stays too far
  };
  Outcome run(const Limits& limits);

  // Whether any attempt made charts.
  bool exist() const { return !best_sizes_.empty(); }
  // Of the best attempt, the less the better.
  double badness() const { return badness_; }
  // What each chart has been found to need, for attempts at a complex that is mostly the same.
  const std::vector<double>& found() const { return feedback_.need().found; }
  // The charts of the best attempt, of which there must be one, unfolded (unfold.h) where that takes them no
  // farther from the surface. Comes last.
  MappedCharts finish();

 private:
  std::vector<uint32_t> uneven() const;
  std::vector<double> measure();
  void stage(const char* name) const;

  std::unique_ptr<const base_complex::BaseComplex> complex_;
  const Target target_;
  const OnStage& on_stage_;
  const std::vector<ChartProfile> profiles_;
  const ArcErrors arc_errors_;
  ChartFeedback feedback_;
  SampledCharts charts_;
  ChartErrors errors_;
  std::vector<ChartSize> best_sizes_;
  double badness_ = std::numeric_limits<double>::infinity();
};

}  // namespace lodestone::geometry_image
