// SPDX-License-Identifier: MIT
// One set of sizes after another: what is kept is what would be made anew, and what is learnt helps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lodestone/geometry_image/chart_errors.h"
#include "lodestone/geometry_image/chart_feedback.h"
#include "lodestone/geometry_image/sampled_charts.h"
#include "lodestone/geometry_image/texel_values.h"
#include "lodestone/geometry_image/weld.h"
#include "meshes.h"
#include "surfaces.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::BaseComplex;

BaseComplex complex_of(base_complex::HalfEdgeMesh mesh) {
  base_complex::CellOptions options;
  options.cells = 12;
  base_complex::Cells grown = grow_cells(mesh, options);
  return build_complex(std::move(mesh), std::move(grown));
}

// A surface, its complex, and what charts of it need.
struct Sample {
  explicit Sample(const base_complex::test::Surface& surface)
      : scene(test::scene_of(
            {test::mesh_of({surface.positions.begin(), surface.positions.end()}, surface.triangles)})),
        assembly(scene::assemble(scene)),
        triangles(surface.triangles),
        complex(complex_of(surface.mesh())),
        arc_errors(complex),
        tree(this->surface()) {
    welded.resize(assembly.positions.size());
    std::iota(welded.begin(), welded.end(), 0u);
    all.resize(triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    for (const base_complex::Cell& cell : complex.cells) {
      const glm::dvec2 extent = extent_of(complex, cell);
      profiles.emplace_back(
          ChartPowers{},
          std::vector<glm::dvec3>{{0, 0, 0}, {extent.x, 0, 0}, {0, extent.y, 0}, {extent.x, extent.y, 0}},
          std::vector<FirmArc>{});
    }
  }
  ChartSource source() const { return {complex, assembly, welded, all, nullptr, true}; }
  mesh::Surface surface() const { return {assembly.positions, triangles}; }
  std::vector<ChartSize> sizes(uint64_t budget, std::vector<double> found = {}) const {
    Need need;
    need.found = std::move(found);
    return choose_sizes(complex, profiles, arc_errors, need, budget);
  }
  std::vector<double> errors(ChartErrors& errors, const SampledCharts& charts) const {
    const std::vector<glm::vec3> points = at_texels(assembly, charts.texels(), assembly.positions);
    return errors.measure({charts.records(), points}, charts.changed());
  }

  scene::Scene scene;
  scene::Assembly assembly;
  std::vector<glm::uvec3> triangles;
  std::vector<uint32_t> welded, all;
  BaseComplex complex;
  ArcErrors arc_errors;
  mesh::TriangleTree tree;
  std::vector<ChartProfile> profiles;
};

size_t count(const std::vector<bool>& flags) {
  return static_cast<size_t>(std::count(flags.begin(), flags.end(), true));
}

// Of a set of sizes, one side of one chart shorter, and its segments with it.
std::vector<ChartSize> with_one_chart_coarser(const Sample& sample, std::vector<ChartSize> sizes) {
  for (size_t c = 0; c < sizes.size(); ++c) {
    const std::array<base_complex::Side, 4> sides = sides_of(sample.complex, sample.complex.cells[c]);
    const bool simple = std::all_of(sides.begin(), sides.end(), [](const base_complex::Side& side) {
      return side.end - side.first == 1;
    });
    if (!simple || sizes[c].width < 2) continue;
    sizes[c].width = 1;
    sizes[c].segments[sides[0].first] = sizes[c].segments[sides[2].first] = 1;
    return sizes;
  }
  return sizes;
}

TEST(SampledCharts, KeepWhatWouldBeMadeAnew) {
  for (const auto& surface : {base_complex::test::sphere(16), base_complex::test::torus(32, 20),
                              base_complex::test::plate_with_holes(2, 3)}) {
    const Sample sample(surface);
    const std::vector<ChartSize> first = sample.sizes(4000), second = with_one_chart_coarser(sample, first);
    SampledCharts charts(sample.source());
    EXPECT_TRUE(charts.resize(first).empty());
    EXPECT_EQ(count(charts.changed()), first.size());
    EXPECT_TRUE(charts.resize(first).empty());
    EXPECT_EQ(count(charts.changed()), 0u);
    EXPECT_TRUE(charts.resize(second).empty());
    EXPECT_LT(count(charts.changed()), first.size());

    SampledCharts anew(sample.source());
    EXPECT_TRUE(anew.resize(second).empty());
    EXPECT_EQ(charts.texels(), anew.texels());
    const MappedCharts a = charts.result(), b = anew.result();
    EXPECT_EQ(a.texels, b.texels);
    EXPECT_EQ(a.repeated_texels, b.repeated_texels);
    EXPECT_EQ(a.mean_stretch, b.mean_stretch);
    EXPECT_EQ(a.high_stretch, b.high_stretch);
    ASSERT_EQ(a.maps.sites.size(), b.maps.sites.size());
    for (size_t i = 0; i < a.maps.sites.size(); ++i) {
      EXPECT_EQ(a.maps.sites[i].at, b.maps.sites[i].at);
      EXPECT_EQ(a.maps.sites[i].face, b.maps.sites[i].face);
    }
    for (size_t c = 0; c < a.charts.size(); ++c) {
      EXPECT_EQ(a.charts[c].first_texel, b.charts[c].first_texel);
      EXPECT_EQ(a.charts[c].width, second[c].width + 1);
      EXPECT_EQ(a.charts[c].height, second[c].height + 1);
    }
  }
}

TEST(ChartErrors, OfWhatChangedAreThoseOfAllMeasuredAnew) {
  for (const auto& surface : {base_complex::test::sphere(24), base_complex::test::torus(40, 24)}) {
    const Sample sample(surface);
    SampledCharts charts(sample.source());
    ChartErrors kept(sample.complex, sample.surface(), sample.tree, 0.1);
    std::vector<double> before;
    const std::vector<ChartSize> fine = sample.sizes(6000);
    for (const std::vector<ChartSize>& sizes : {fine, with_one_chart_coarser(sample, fine), fine}) {
      ASSERT_TRUE(charts.resize(sizes).empty());
      const std::vector<double> errors = sample.errors(kept, charts);
      SampledCharts anew(sample.source());
      ASSERT_TRUE(anew.resize(sizes).empty());
      ChartErrors fresh(sample.complex, sample.surface(), sample.tree, 0.1);
      EXPECT_EQ(errors, sample.errors(fresh, anew));
      EXPECT_NE(errors, before);
      before = errors;
    }
  }
}

TEST(ChartErrors, AreHowFarCoarseChartsAreFromASphere) {
  const Sample sample(base_complex::test::sphere(48));
  SampledCharts charts(sample.source());
  ChartErrors errors(sample.complex, sample.surface(), sample.tree, 0.05);
  ASSERT_TRUE(charts.resize(sample.sizes(0)).empty());
  const std::vector<double> coarse = sample.errors(errors, charts);
  ASSERT_TRUE(charts.resize(sample.sizes(40000)).empty());
  const std::vector<double> fine = sample.errors(errors, charts);
  // A dozen patches of single quads leave a gap of a good tenth of the radius; fine ones hardly any.
  EXPECT_GT(*std::max_element(coarse.begin(), coarse.end()), 0.1);
  EXPECT_LT(*std::max_element(coarse.begin(), coarse.end()), 1);
  EXPECT_LT(*std::max_element(fine.begin(), fine.end()), 0.01);
}

class Feedback : public testing::Test {
 protected:
  const Sample sample{base_complex::test::sphere(16)};
  ChartFeedback feedback{sample.complex, sample.arc_errors, 1.0, Need{0.04, 0.5, 0.2, {}, {}, {}}};
  std::vector<ChartSize> sizes = sample.sizes(2000);
  std::vector<double> errors = std::vector<double>(sample.complex.cells.size(), 0.8);

  // As another attempt would have it: the first chart with so many times as many quads.
  void refine_first(uint32_t times) { sizes[0].width *= times; }
  double found() const { return feedback.need().found[0]; }
};

TEST_F(Feedback, HasNothingToTeachWhereAllIsNearEnough) {
  EXPECT_FALSE(feedback.learn(sizes, errors));
  EXPECT_EQ(found(), 0);
}

TEST_F(Feedback, AsksForMoreTheFartherAChartIs) {
  errors[0] = 1.5;
  errors[1] = 3;
  EXPECT_TRUE(feedback.learn(sizes, errors));
  EXPECT_GT(found(), 0.04);
  EXPECT_GT(feedback.need().found[1], found());
  const double before = found();
  EXPECT_TRUE(feedback.learn(sizes, errors));
  EXPECT_GT(found(), before);
}

TEST_F(Feedback, SettlesASizeThatWasEnough) {
  EXPECT_EQ(feedback.need().fixed[0], Quads{});
  errors[0] = 2;
  feedback.learn(sizes, errors);
  EXPECT_EQ(feedback.need().fixed[0], Quads{});
  const double before = found();
  refine_first(2);
  errors[0] = 0.9;
  EXPECT_TRUE(feedback.learn(sizes, errors));
  EXPECT_EQ(feedback.need().fixed[0], (Quads{sizes[0].width, sizes[0].height}));
  EXPECT_EQ(found(), before);
  EXPECT_EQ(feedback.need().fixed[1], Quads{}) << "it had enough all the time";
  EXPECT_FALSE(feedback.learn(sizes, errors));
  // Arcs may become coarser with the charts beside it, and its size too little.
  errors[0] = 1.1;
  EXPECT_TRUE(feedback.learn(sizes, errors));
  EXPECT_EQ(feedback.need().fixed[0], Quads{});
  EXPECT_GT(found(), before);
}

TEST_F(Feedback, GivesUpOnAChartThatCloserSamplesDoNotHelp) {
  errors[0] = 1.1;
  const Quads first = {sizes[0].width, sizes[0].height};
  EXPECT_TRUE(feedback.learn(sizes, errors));
  EXPECT_EQ(feedback.always_far(errors), std::vector<uint32_t>{0});
  for (int i = 0; i < 4; ++i) {
    const double before = found();
    EXPECT_TRUE(feedback.learn(sizes, errors));
    EXPECT_GT(found(), before) << "it asks for more, and has not got it yet";
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(feedback.need().fixed[0], Quads{});
    refine_first(2);
    errors[0] = 1.1 + i;
    EXPECT_TRUE(feedback.learn(sizes, errors));
  }
  EXPECT_EQ(feedback.need().fixed[0], first) << "the least that was as good";
  EXPECT_FALSE(feedback.learn(sizes, errors));
  EXPECT_EQ(feedback.always_far(errors), std::vector<uint32_t>{0});
  errors[0] = 0.9;
  EXPECT_TRUE(feedback.always_far(errors).empty());
}

TEST_F(Feedback, DoesNotCallAChartFarThatWasNearOnce) {
  feedback.learn(sizes, errors);
  errors[0] = 2;
  feedback.learn(sizes, errors);
  EXPECT_TRUE(feedback.always_far(errors).empty());
}

TEST_F(Feedback, GoesOnFromWhatWasFoundBefore) {
  Need need{0.04, 0.5, 0.2, {0.1}, {}, {}};
  ChartFeedback later(sample.complex, sample.arc_errors, 1.0, need);
  EXPECT_EQ(later.need().found[0], 0.1);
  EXPECT_EQ(later.need().found.size(), errors.size());
  EXPECT_TRUE(later.learn(sizes, errors));
  EXPECT_EQ(later.need().fixed[0], (Quads{sizes[0].width, sizes[0].height}));
}

TEST_F(Feedback, FindsAnAttemptWorseTheFartherItsWorstChartIs) {
  std::vector<double> worse = errors;
  worse[1] = 1.2;
  EXPECT_GT(feedback.badness(worse), feedback.badness(errors));
  // One that is far counts more than all that are a little too far.
  EXPECT_GT(feedback.badness(worse), feedback.badness(std::vector<double>(errors.size(), 0.85)));
  EXPECT_EQ(feedback.badness(std::vector<double>(errors.size(), 0.0)), 0);
}

}  // namespace
}  // namespace lodestone::geometry_image
