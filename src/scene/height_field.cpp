// SPDX-License-Identifier: MIT
#include "lodestone/scene/height_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "lodestone/base/parallel.h"

namespace lodestone::scene {
namespace {

class HeightField {
 public:
  HeightField(uint32_t width, uint32_t height, std::span<const float> samples)
      : width_(width), height_(height), samples_(samples) {}

  void fill_vertices(Mesh& mesh) const {
    const size_t count = size_t(width_) * height_;
    mesh.positions.resize(count);
    mesh.normals.resize(count);
    mesh.texcoords[0].resize(count);
    constexpr uint64_t rows_at_once = 16;
    parallel_for(height_, rows_at_once, [&](uint64_t begin, uint64_t end) {
      for (uint64_t y = begin; y < end; ++y) fill_row(static_cast<uint32_t>(y), mesh);
    });
  }

  void fill_grids(Mesh& mesh) const {
    mesh.triangles.resize(2 * size_t(width_ - 1) * (height_ - 1));
    constexpr uint32_t quads = max_grid_side - 1;
    uint32_t first_triangle = 0;
    for (uint32_t y = 0; y < height_ - 1; y += quads) {
      for (uint32_t x = 0; x < width_ - 1; x += quads) {
        Grid grid;
        grid.width = std::min(max_grid_side, width_ - x);
        grid.height = std::min(max_grid_side, height_ - y);
        grid.first_triangle = first_triangle;
        fill_grid(x, y, grid, mesh);
        first_triangle += 2 * (grid.width - 1) * (grid.height - 1);
        mesh.grids.push_back(std::move(grid));
      }
    }
  }

 private:
  void fill_row(uint32_t y, Mesh& mesh) const {
    for (uint32_t x = 0; x < width_; ++x) {
      const size_t vertex = size_t(y) * width_ + x;
      mesh.positions[vertex] = {centred(x, width_), at(x, y), -centred(y, height_)};
      mesh.normals[vertex] = normal(x, y);
      mesh.texcoords[0][vertex] = {share(x, width_), share(height_ - 1 - y, height_)};
    }
  }

  // Rows here count from the near side, those of the samples from the far one.
  float at(uint32_t x, uint32_t y) const { return samples_[size_t(height_ - 1 - y) * width_ + x]; }

  static float centred(uint32_t i, uint32_t count) {
    return static_cast<float>(i) - 0.5f * static_cast<float>(count - 1);
  }

  static float share(uint32_t i, uint32_t count) {
    return static_cast<float>(i) / static_cast<float>(count - 1);
  }

  // In double precision, which differences of heights as large as a float holds do not overflow.
  glm::vec3 normal(uint32_t x, uint32_t y) const {
    const uint32_t left = x == 0 ? 0 : x - 1, right = std::min(x + 1, width_ - 1);
    const uint32_t near = y == 0 ? 0 : y - 1, far = std::min(y + 1, height_ - 1);
    const double along_x = (double(at(right, y)) - at(left, y)) / (right - left);
    const double along_y = (double(at(x, far)) - at(x, near)) / (far - near);
    const glm::dvec3 up(-along_x, 1, along_y);  // rows run towards -Z
    return glm::vec3(up / std::sqrt(glm::dot(up, up)));
  }

  void fill_grid(uint32_t x0, uint32_t y0, Grid& grid, Mesh& mesh) const {
    grid.vertices.reserve(size_t(grid.width) * grid.height);
    for (uint32_t y = y0; y < y0 + grid.height; ++y) {
      for (uint32_t x = x0; x < x0 + grid.width; ++x) grid.vertices.push_back(y * width_ + x);
    }
    size_t triangle = grid.first_triangle;
    for (uint32_t y = 0; y + 1 < grid.height; ++y) {
      for (uint32_t x = 0; x + 1 < grid.width; ++x) {
        const uint32_t a = grid.vertices[size_t(y) * grid.width + x], c = a + width_;
        mesh.triangles[triangle++] = {a, a + 1, c};
        mesh.triangles[triangle++] = {c + 1, c, a + 1};
      }
    }
  }

  uint32_t width_, height_;
  std::span<const float> samples_;
};

}  // namespace

Mesh make_height_field(uint32_t width, uint32_t height, std::span<const float> samples) {
  Mesh mesh;
  const HeightField field(width, height, samples);
  field.fill_vertices(mesh);
  field.fill_grids(mesh);
  return mesh;
}

}  // namespace lodestone::scene
