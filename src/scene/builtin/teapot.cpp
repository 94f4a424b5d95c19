// SPDX-License-Identifier: MIT
#include "lodestone/scene/builtin/teapot.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>

#include "lodestone/scene/builtin/surface.h"
#include "lodestone/scene/builtin/teapot_patches.h"

namespace lodestone::scene::builtin {
namespace {

constexpr uint32_t cells_across = 16;  // quads along the columns of a patch
// Along a side of a cap: as many around it as around four patches.
constexpr int cap_cells = int(cells_across);

// Vertices of one sheet: samples at the same place are one, so that charts share their borders.
class Vertices {
 public:
  explicit Vertices(Mesh& mesh) : mesh_(mesh) {}

  uint32_t add(const PatchSample& sample, glm::vec3 pole_normal) {
    const glm::vec3 position = snap(sample.position);
    const auto [known, is_new] =
        known_.try_emplace({position.x, position.y, position.z}, uint32_t(mesh_.positions.size()));
    if (is_new) {
      const glm::vec3 normal = glm::cross(sample.along_u, sample.along_v);
      const float length = glm::length(normal);
      mesh_.positions.push_back(position);
      mesh_.normals.push_back(length > 0 ? snap(normal / length) : pole_normal);
    }
    return known->second;
  }

 private:
  Mesh& mesh_;
  std::map<std::array<float, 3>, uint32_t> known_;
};

// The rows of a patch that become a grid: v from `first` to `last` in `cells` steps.
struct Band {
  float first, last;
  uint32_t cells;
};

void add_band(Mesh& mesh, Vertices& vertices, const BezierPatch& patch, Band band) {
  Grid grid{cells_across + 1, band.cells + 1, 0, {}};
  for (uint32_t y = 0; y <= band.cells; ++y)
    for (uint32_t x = 0; x <= cells_across; ++x) {
      const float u = float(x) / cells_across;
      const float v = glm::mix(band.first, band.last, float(y) / float(band.cells));
      grid.vertices.push_back(vertices.add(sample_patch(patch, u, v), glm::vec3(0)));
    }
  add_grid(mesh, std::move(grid));
}

// The square over what a band leaves of four patches around a pole at v = `pole`, from v = `border`. Its
// rings are circles (Shirley and Chiu's concentric map).
void add_cap(Mesh& mesh, Vertices& vertices, const BezierPatch* patches, float pole, float border) {
  constexpr int half = cap_cells / 2;
  const glm::vec3 normal(0, pole == 0 ? 1 : -1, 0);
  Grid grid{cap_cells + 1, cap_cells + 1, 0, {}};
  for (int y = -half; y <= half; ++y)
    for (int x = -half; x <= half; ++x) {
      // Along the square from the middle of the side a > 0 to the side b > 0; such that the chart faces
      // outwards.
      const int a = pole == 0 ? y : x, b = pole == 0 ? x : y;
      const int ring = std::max(std::abs(a), std::abs(b));
      int along = 0;  // of 8 * ring
      if (a == ring)
        along = (b + 8 * ring) % std::max(8 * ring, 1);
      else if (b == ring)
        along = 2 * ring - a;
      else if (a == -ring)
        along = 4 * ring - b;
      else
        along = 6 * ring + a;
      const int quarter = ring == 0 ? 0 : along / (2 * ring);
      const float u = ring == 0 ? 0 : float(along - quarter * 2 * ring) / float(2 * ring);
      const float v = glm::mix(pole, border, float(ring) / half);
      grid.vertices.push_back(vertices.add(sample_patch(patches[quarter], u, v), normal));
    }
  add_grid(mesh, std::move(grid));
}

void add_sheet(Mesh& mesh, const PatchSheet& sheet, const std::vector<Band>& bands) {
  Vertices vertices(mesh);
  for (size_t row = 0; row < bands.size(); ++row) {
    const BezierPatch* patches = &sheet.patches[row * sheet.columns];
    const Band& band = bands[row];
    if (band.first > 0) add_cap(mesh, vertices, patches, 0, band.first);
    for (uint32_t column = 0; column < sheet.columns; ++column)
      add_band(mesh, vertices, patches[column], band);
    if (band.last < 1) add_cap(mesh, vertices, patches, 1, band.last);
  }
}

// Where a band ends early there is a pole. The rim and the rounding of the bottom are narrow.
std::vector<Band> bands_of(const PatchSheet& sheet) {
  if (sheet.name == "body") return {{0, 1, 8}, {0, 1, 16}, {0, 1, 16}, {0, 0.5f, 8}};
  if (sheet.name == "lid") return {{0.25f, 1, 16}, {0, 1, 16}};
  return {{0, 1, 16}, {0, 1, 16}};
}

}  // namespace

Mesh teapot(const std::string& name, uint32_t material) {
  Mesh mesh;
  mesh.name = name;
  for (const PatchSheet& sheet : teapot_patches()) add_sheet(mesh, sheet, bands_of(sheet));
  add_part(mesh, 0, material);
  return mesh;
}

}  // namespace lodestone::scene::builtin
