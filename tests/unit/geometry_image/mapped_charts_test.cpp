// SPDX-License-Identifier: MIT
// What AtlasKind::charts promises of any mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

#include "brute_force.h"
#include "expect_error.h"
#include "lodestone/base/parallel.h"
#include "lodestone/geometry_image/atlas_check.h"
#include "lodestone/geometry_image/atlas_file.h"
#include "lodestone/geometry_image/texel_values.h"
#include "meshes.h"
#include "surfaces.h"

namespace lodestone::geometry_image {
namespace {

namespace shapes = base_complex::test;

scene::Mesh mesh_from(const shapes::Surface& surface) {
  return test::mesh_of({surface.positions.begin(), surface.positions.end()}, surface.triangles);
}

shapes::Surface cube() {
  shapes::Surface s;
  for (int i = 0; i < 8; ++i) s.add({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  s.add_quad(0, 2, 3, 1);
  s.add_quad(4, 5, 7, 6);
  s.add_quad(0, 1, 5, 4);
  s.add_quad(2, 6, 7, 3);
  s.add_quad(0, 4, 6, 2);
  s.add_quad(1, 3, 7, 5);
  return s;
}

AtlasSettings settings_of(uint64_t budget, Signal signal = Signal::area) {
  AtlasSettings settings(AtlasKind::charts);
  settings.charts.texel_budget = budget;
  settings.charts.signal = signal;
  return settings;
}

// An atlas and where its texels are, checked for what all have in common.
struct Made {
  explicit Made(const scene::Scene& of_scene, const AtlasSettings& settings = AtlasKind::charts)
      : scene(of_scene), assembly(scene::assemble(scene)), atlas(build_atlas(scene, assembly, settings)) {
    EXPECT_EQ(find_fault(atlas), "");
    points = at_texels(assembly, atlas.texel_map, assembly.positions);
    for (size_t i = 0; i < points.size(); ++i)
      EXPECT_TRUE(atlas.texel_map[i].w == 0 ||
                  (std::isfinite(points[i].x) && std::isfinite(points[i].y) && std::isfinite(points[i].z)));
    EXPECT_TRUE(std::isfinite(atlas.report.mean_stretch));
    for (const layout::ChartRecord& chart : atlas.charts) expect_one_part(chart);
  }
  explicit Made(const scene::Mesh& mesh, const AtlasSettings& settings = AtlasKind::charts)
      : Made(test::scene_of({mesh}), settings) {}
  explicit Made(const shapes::Surface& surface, const AtlasSettings& settings = AtlasKind::charts)
      : Made(mesh_from(surface), settings) {}

  void for_each_texel(const layout::ChartRecord& chart, const std::function<void(size_t)>& visit) const {
    for (size_t i = 0; i < size_t(chart.width) * chart.height; ++i)
      if (atlas.texel_map[chart.first_texel + i].w != 0) visit(chart.first_texel + i);
  }
  void for_each_triangle(const std::function<void(uint32_t, uint32_t, uint32_t)>& visit) const {
    for (const glm::uvec2& leaf : atlas.leaf_map) {
      if (leaf.x == layout::empty_slot) continue;
      const uint32_t a = leaf.x, b = a + 1, c = a + leaf.y, d = c + 1;
      visit(a, b, c);
      visit(d, c, b);
    }
  }
  void expect_one_part(const layout::ChartRecord& chart) const {
    std::set<uint32_t> parts;
    for_each_texel(chart, [&](size_t i) { parts.insert(assembly.triangles[atlas.texel_map[i].x].w); });
    EXPECT_EQ(parts.size(), 1u) << "a chart across a border between parts";
  }

  double area() const {
    double sum = 0;
    for_each_triangle([&](uint32_t a, uint32_t b, uint32_t c) {
      const glm::dvec3 at = points[a];
      sum += glm::length(glm::cross(glm::dvec3(points[b]) - at, glm::dvec3(points[c]) - at)) / 2;
    });
    return sum;
  }
  // Points that are equal to the bit are one; what has collapsed does not count.
  int64_t euler_characteristic() const {
    std::set<test::PositionBits> corners;
    std::set<std::pair<test::PositionBits, test::PositionBits>> edges;
    int64_t triangles = 0;
    for_each_triangle([&](uint32_t a, uint32_t b, uint32_t c) {
      const test::PositionBits p[3] = {test::bits_of(points[a]), test::bits_of(points[b]),
                                       test::bits_of(points[c])};
      if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return;
      ++triangles;
      for (int k = 0; k < 3; ++k) {
        corners.insert(p[k]);
        edges.insert(std::minmax(p[k], p[(k + 1) % 3]));
      }
    });
    return int64_t(corners.size()) - int64_t(edges.size()) + triangles;
  }
  uint64_t boundary_edges() const {
    test::EdgeCounts edges;
    for_each_triangle(
        [&](uint32_t a, uint32_t b, uint32_t c) { edges.add(points[a], points[b], points[c]); });
    return edges.boundary();
  }
  bool has_point(const glm::vec3& p) const { return std::count(points.begin(), points.end(), p) > 0; }

  scene::Scene scene;
  scene::Assembly assembly;
  Atlas atlas;
  std::vector<glm::vec3> points;
};

double area_of(const shapes::Surface& surface) {
  const base_complex::HalfEdgeMesh mesh = surface.mesh();
  double sum = 0;
  for (uint32_t f = 0; f < mesh.faces(); ++f) sum += mesh.area(f);
  return sum;
}

struct Closed {
  std::string name;
  shapes::Surface surface;
  int64_t euler;
};

std::vector<Closed> closed_surfaces() {
  return {{"sphere", shapes::sphere(16), 2},
          {"torus", shapes::torus(32, 20), 0},
          {"genus 2", shapes::plate_with_holes(2, 4), -2},
          {"genus 3", shapes::plate_with_holes(3, 2), -4},
          {"tetrahedron", shapes::tetrahedron(), 2},
          {"cube", cube(), 2}};
}

TEST(MappedCharts, CoverAClosedSurfaceAndKeepItsTopology) {
  for (const Closed& closed : closed_surfaces()) {
    for (const Signal signal : {Signal::area, Signal::curvature}) {
      SCOPED_TRACE(closed.name + (signal == Signal::area ? ", area" : ", curvature"));
      const Made made(closed.surface, settings_of(1 << 14, signal));
      EXPECT_EQ(made.atlas.report.mapped_triangles, closed.surface.triangles.size());
      EXPECT_EQ(made.atlas.report.mapped_charts, made.atlas.charts.size());
      EXPECT_NEAR(made.area(), area_of(closed.surface), 0.03 * area_of(closed.surface));
      EXPECT_EQ(made.euler_characteristic(), closed.euler);
      EXPECT_EQ(made.boundary_edges(), 0u);
    }
  }
}

TEST(MappedCharts, CoverOpenSurfaces) {
  const auto is_hole = [](uint32_t x, uint32_t y) { return x % 5 == 2 && y % 5 == 2; };
  const std::pair<shapes::Surface, int64_t> open[] = {{shapes::plane(20, 15), 1},
                                                      {shapes::plane(15, 10, is_hole), 1 - 6},
                                                      {shapes::annulus(24, 6), 0},
                                                      {shapes::moebius(30, 5), 0}};
  for (const auto& [surface, euler] : open) {
    const Made made(surface, settings_of(1 << 14));
    EXPECT_EQ(made.atlas.report.mapped_triangles, surface.triangles.size());
    EXPECT_NEAR(made.area(), area_of(surface), 0.03 * area_of(surface));
    EXPECT_EQ(made.euler_characteristic(), euler);
    EXPECT_GT(made.boundary_edges(), 0u);
  }
}

TEST(MappedCharts, LieOnTheInput) {
  const Made made(shapes::sphere(30), settings_of(1 << 13));
  for (const glm::vec3& p : made.points) {
    EXPECT_LE(glm::length(p), 1 + 1e-6f);
    EXPECT_GE(glm::length(p), 0.99f);
  }
}

TEST(MappedCharts, KeepTheBudget) {
  for (const Closed& closed : closed_surfaces()) {
    for (const Signal signal : {Signal::area, Signal::curvature}) {
      uint64_t before = 0;
      for (const uint64_t budget : {1u << 12, 1u << 13, 1u << 15}) {
        const Made made(closed.surface, settings_of(budget, signal));
        EXPECT_LE(made.atlas.report.texels, budget) << closed.name;
        EXPECT_GT(made.atlas.report.texels, before) << closed.name;
        before = made.atlas.report.texels;
      }
    }
  }
}

TEST(MappedCharts, AreTheSameOnAnyNumberOfThreads) {
  std::vector<scene::Mesh> meshes = {mesh_from(shapes::torus(64, 40)), mesh_from(cube()),
                                     test::random_mesh(3, 60, 150)};
  for (const Signal signal : {Signal::area, Signal::curvature}) {
    const scene::Scene scene = test::scene_of(meshes);
    std::vector<std::byte> expected;
    for (const uint32_t threads : {1u, 2u, 7u}) {
      set_thread_count(threads);
      const std::vector<std::byte> packed =
          pack_atlas(test::atlas_of(scene, settings_of(0, signal)), {"hash"});
      if (expected.empty()) expected = packed;
      EXPECT_EQ(packed == expected, true) << threads;
    }
  }
  set_thread_count(0);
}

TEST(MappedCharts, OfACubeHaveItsCornersAndEdges) {
  const Made made(cube(), settings_of(1 << 12));
  EXPECT_NEAR(made.area(), 24, 1e-5);
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(made.has_point({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1}));
  for (const glm::vec3& p : made.points)
    EXPECT_EQ(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1) << "a point that is on no side";
  // No chart goes round an edge, so all of its points have a coordinate in common.
  for (const layout::ChartRecord& chart : made.atlas.charts) {
    glm::vec3 lo(2), hi(-2);
    made.for_each_texel(chart, [&](size_t i) {
      lo = glm::min(lo, made.points[i]);
      hi = glm::max(hi, made.points[i]);
    });
    EXPECT_TRUE(lo.x == hi.x || lo.y == hi.y || lo.z == hi.z);
  }
  // Of small triangles' edges along an edge of the cube there are two each, and they cover it; what has three
  // corners there does not count.
  double length = 0;
  made.for_each_triangle([&](uint32_t a, uint32_t b, uint32_t c) {
    const glm::vec3 p[3] = {made.points[a], made.points[b], made.points[c]};
    if (glm::cross(p[1] - p[0], p[2] - p[0]) == glm::vec3(0)) return;
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 &u = p[k], &v = p[(k + 1) % 3];
      int common = 0;
      for (glm::length_t axis = 0; axis < 3; ++axis)
        common += std::abs(u[axis]) == 1 && u[axis] == v[axis] ? 1 : 0;
      if (common == 2) length += glm::distance(u, v);
    }
  });
  EXPECT_NEAR(length, 2 * 12 * 2, 1e-4);
}

TEST(MappedCharts, OfFewTrianglesHaveTheirCorners) {
  const shapes::Surface one = shapes::single_triangle();
  shapes::Surface two = one;
  two.add({1, 1, 0});
  two.triangles.emplace_back(1, 3, 2);
  for (const shapes::Surface& surface : {one, two, shapes::tetrahedron(), shapes::sheets(3)}) {
    const Made made(surface, settings_of(1 << 12));
    EXPECT_NEAR(made.area(), area_of(surface), 0.01 * area_of(surface));
    for (const glm::dvec3& p : surface.positions) EXPECT_TRUE(made.has_point(p));
  }
  EXPECT_EQ(Made(one).euler_characteristic(), 1);
  EXPECT_EQ(Made(two).euler_characteristic(), 1);
}

// Its area says nothing about how long it is: splitting its edges by that had no end.
TEST(MappedCharts, OfANeedleAreFew) {
  shapes::Surface needle;
  for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0.5, 1e-9, 0)})
    needle.add(p);
  needle.triangles.emplace_back(0, 1, 2);
  const Made made(needle, settings_of(1 << 12));
  EXPECT_LE(made.atlas.charts.size(), 4u);
}

TEST(MappedCharts, EndWherePartsDo) {
  scene::Mesh mesh = mesh_from(shapes::plane(20, 20));
  // Rows of the plane, half of the first part's last row included.
  mesh.parts = {{0, 410, scene::none}, {410, 390, scene::none}};
  const Made made(mesh, settings_of(1 << 13));  // expects one part a chart
  EXPECT_NEAR(made.area(), 400, 1);
  EXPECT_EQ(made.euler_characteristic(), 1);
}

// A tube whose texture coordinates go once round; along the seam its vertices are there twice.
TEST(MappedCharts, EndWhereTextureCoordinatesJump) {
  constexpr uint32_t around = 24, rows = 20;
  scene::Mesh mesh = test::mesh_of({}, {});
  std::vector<uint32_t> vertices;
  for (uint32_t y = 0; y <= rows; ++y) {
    for (uint32_t x = 0; x <= around; ++x) {
      const double angle = 2 * shapes::pi * (x % around) / around;
      mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.2 * y);
      mesh.texcoords[0].emplace_back(float(x) / around, float(y) / rows);
    }
  }
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0, 0, 1));
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t x = 0; x < around; ++x) {
      const uint32_t a = y * (around + 1) + x, d = a + around + 1;
      mesh.triangles.insert(mesh.triangles.end(), {{a, a + 1, d + 1}, {a, d + 1, d}});
    }
  }
  mesh.parts = {{0, static_cast<uint32_t>(mesh.triangles.size()), scene::none}};
  const Made made(mesh, settings_of(1 << 13));
  const auto texcoord = [&](uint32_t texel) {
    const glm::uvec4& map = made.atlas.texel_map[texel];
    const glm::uvec4& t = made.assembly.triangles[map.x];
    const float b1 = std::bit_cast<float>(map.y), b2 = std::bit_cast<float>(map.z);
    const std::vector<glm::vec2>& uv = made.assembly.texcoords[0];
    return (1 - b1 - b2) * uv[t.x] + b1 * uv[t.y] + b2 * uv[t.z];
  };
  made.for_each_triangle([&](uint32_t a, uint32_t b, uint32_t c) {
    EXPECT_LT(glm::distance(texcoord(a), texcoord(b)), 0.5);
    EXPECT_LT(glm::distance(texcoord(b), texcoord(c)), 0.5);
  });
  EXPECT_EQ(made.euler_characteristic(), 0);
}

TEST(MappedCharts, TakeDegenerateDuplicateAndNonManifoldTriangles) {
  shapes::Surface surface = shapes::plane(6, 6);
  surface.triangles.push_back(surface.triangles[3]);                 // duplicate
  surface.triangles.emplace_back(0, 0, 1);                           // collapsed
  surface.triangles.emplace_back(0, 1, 2);                           // on a line
  surface.triangles.emplace_back(8, 9, surface.add({1.5, 1.5, 1}));  // fins
  surface.triangles.emplace_back(9, 8, surface.add({1.5, 1.5, -1}));
  for (const Signal signal : {Signal::area, Signal::curvature}) {
    const Made made(surface, settings_of(1 << 12, signal));
    EXPECT_EQ(made.atlas.report.duplicate_triangles, 1u);
    EXPECT_GT(made.atlas.report.non_manifold_edges, 0u);
    EXPECT_NEAR(made.area(), area_of(shapes::plane(6, 6)) + 2 * 0.5 * std::sqrt(1.25), 0.5);
  }
}

TEST(MappedCharts, TakeAnything) {
  for (uint32_t seed = 0; seed < 12; ++seed) {
    for (const Signal signal : {Signal::area, Signal::curvature})
      Made made(test::random_mesh(seed, 10 + 15 * seed, 20 + 25 * seed), settings_of(0, signal));
  }
}

TEST(MappedCharts, TakeEverySampleSurface) {
  for (const shapes::Sample& sample : shapes::all_samples()) {
    SCOPED_TRACE(sample.name);
    shapes::Surface surface;
    for (uint32_t p = 0; p < sample.mesh.points(); ++p) surface.add(sample.mesh.position(p));
    for (uint32_t f = 0; f < sample.mesh.faces(); ++f) {
      const std::array<uint32_t, 3> c = sample.mesh.corners(f);
      surface.triangles.emplace_back(c[0], c[1], c[2]);
    }
    const Made made(surface, settings_of(1 << 15));
    const double area = area_of(surface);
    EXPECT_NEAR(made.area(), area, 0.05 * area);
  }
}

// A morph target opens what has no extent at rest.
TEST(MappedCharts, TakeASurfaceThatIsOnePointAtRest) {
  const shapes::Surface open = shapes::plane(6, 6);
  scene::Mesh mesh = mesh_from(open);
  scene::MorphTarget& target = mesh.targets.emplace_back();
  target.name = "open";
  for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
    target.vertices.push_back(v);
    target.positions.push_back(mesh.positions[v] + glm::vec3(1, 0, 0));
    mesh.positions[v] = glm::vec3(0);
  }
  mesh.weights = {0.0f};
  for (const bool all_shapes : {false, true}) {
    AtlasSettings settings(AtlasKind::charts);
    settings.charts.all_shapes = all_shapes;
    const Made made(mesh, settings);
    EXPECT_EQ(made.area(), 0);
    EXPECT_GT(made.atlas.report.texels, 0u);
  }
}

TEST(MappedCharts, OfATriangleOrTwoInAPlaneAreAllOfThem) {
  shapes::Surface one, two;
  for (shapes::Surface* s : {&one, &two}) {
    s->add({0, 0, 0});
    s->add({3, 0, 0.25});
    s->add({0, 1, 0.5});
    s->triangles.emplace_back(0, 1, 2);
  }
  two.add({-1, 0.5, 1.0 / 6});
  two.triangles.emplace_back(0, 2, 3);
  for (const shapes::Surface& surface : {one, two}) {
    for (const uint64_t budget : {4u, 9u, 100u}) {
      const Made made(surface, settings_of(budget));
      EXPECT_EQ(made.atlas.charts.size(), 1u);
      const AtlasReport& report = made.atlas.report;
      // A flat corner may be no corner of the rectangle.
      EXPECT_LE(report.texels, std::max(budget, uint64_t(6)));
      double area = 0;
      for (const glm::uvec3& t : surface.triangles)
        area += 0.5 * glm::length(glm::cross(surface.positions[t.y] - surface.positions[t.x],
                                             surface.positions[t.z] - surface.positions[t.x]));
      EXPECT_NEAR(made.area(), area, 1e-6 * area) << budget;
    }
  }
}

TEST(MappedCharts, SayWhereTheyNeedMoreTexelsThanWereAskedFor) {
  const Made few(cube(), settings_of(4)), enough(cube(), settings_of(1000));
  ASSERT_EQ(few.atlas.report.notes.size(), 1u);
  EXPECT_NE(few.atlas.report.notes[0].find("4 texels were asked for, but its 6 charts need"),
            std::string::npos);
  EXPECT_TRUE(enough.atlas.report.notes.empty());
}

// A road from under the camera to far away.
scene::Scene road_with_camera() {
  scene::Scene scene = test::scene_of({mesh_from(shapes::plane(200, 8))});
  scene.cameras.emplace_back();
  scene.nodes.emplace_back();
  scene.nodes.back().camera = 0;
  scene.nodes.back().translation = {-1, 4, 1};
  scene.nodes.back().rotation = glm::quat(glm::vec3(glm::half_pi<float>(), -glm::half_pi<float>(), 0));
  return scene;
}

TEST(MappedCharts, HaveMoreTexelsNearTheCamerasOfTheScene) {
  const auto texels_before = [](Signal signal, float x) {
    const Made made(road_with_camera(), settings_of(4000, signal));
    EXPECT_LE(made.points.size(), 4000u);
    return std::count_if(made.points.begin(), made.points.end(), [x](const glm::vec3& p) { return p.x < x; });
  };
  EXPECT_GT(texels_before(Signal::screen, 20), 2 * texels_before(Signal::area, 20));
}

TEST(MappedCharts, OfAnotherCameraHaveAnotherHash) {
  scene::Scene scene = road_with_camera();
  const auto hash = [&](Signal signal) {
    return atlas_hash(scene, scene::assemble(scene), settings_of(4000, signal));
  };
  const std::string screen = hash(Signal::screen), area = hash(Signal::area);
  scene.nodes.back().translation.x += 1;
  EXPECT_NE(hash(Signal::screen), screen);
  EXPECT_EQ(hash(Signal::area), area) << "cameras do not count there";
}

TEST(MappedCharts, ForTheScreenNeedACamera) {
  test::expect_error([] { Made(shapes::plane(4, 4), settings_of(100, Signal::screen)); }, ExitCode::usage,
                     "--signal screen", "needs a camera");
}

}  // namespace
}  // namespace lodestone::geometry_image
