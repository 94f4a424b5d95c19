// SPDX-License-Identifier: MIT
#include "lodestone/render/environment_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "lodestone/base/parallel.h"
#include "lodestone/layout/shading.h"
#include "lodestone/render/number_shares.h"
#include "lodestone/render/scene_tables.h"
#include "lodestone/render/view.h"

namespace lodestone::render {
namespace {

// Rows of the raster that the sky's density comes from. It is the same all round, so one column is enough.
constexpr uint32_t sky_rows = 64;

double luminance(const glm::vec3& radiance) {
  return 0.2126 * double(radiance.x) + 0.7152 * double(radiance.y) + 0.0722 * double(radiance.z);
}

// The rows of cells of a map of `height` rows of texels: where they begin and end, and the solid angle of all
// of each. They lie between the centres of texels, the first and the last at a pole.
class Rows {
 public:
  explicit Rows(uint32_t height) : height_(height) {}
  uint32_t count() const { return height_ + 1; }
  // From the nearer pole, along the axis, of the upper (0) or the lower (1) border.
  double polar_distance(uint32_t row, uint32_t border) const {
    const double below = std::clamp((row + border - 0.5) / height_, 0.0, 1.0);
    const double sine = std::sin(std::numbers::pi / 2 * (is_upper(row) ? below : 1 - below));
    return 2 * sine * sine;  // 1 - cos
  }
  double solid_angle(uint32_t row) const {
    return 2 * std::numbers::pi * std::abs(polar_distance(row, 1) - polar_distance(row, 0));
  }

 private:
  // As in sample_environment.
  bool is_upper(uint32_t row) const { return 2 * row <= height_; }
  uint32_t height_;
};

// Cells and rows; texel(x, y): the luminance of one.
template <class Texel>
void make_distribution(EnvironmentData& data, const Texel& texel) {
  const uint32_t width = data.record.width, height = data.record.height;
  const Rows rows(height);
  std::vector<double> light(rows.count());  // of each row
  data.cells.resize(size_t(rows.count()) * (width + 1));
  parallel_for(rows.count(), 16, [&](uint64_t begin, uint64_t end) {
    std::vector<double> pairs(width + 1), weights(width);
    for (auto row = static_cast<uint32_t>(begin); row < end; ++row) {
      const uint32_t upper = row == 0 ? 0 : row - 1, lower = std::min(row, height - 1);
      for (uint32_t x = 0; x < width; ++x) pairs[x] = texel(x, upper) + texel(x, lower);
      pairs[width] = pairs[0];
      double sum = 0;
      for (uint32_t x = 0; x < width; ++x) {
        weights[x] = (pairs[x] + pairs[x + 1]) / 4;
        sum += weights[x];
      }
      light[row] = sum / width * rows.solid_angle(row);
      share_out(weights, std::span(data.cells).subspan(size_t(row) * (width + 1), width + 1));
    }
  });
  for (const double of_row : light) data.light += of_row;
  if (data.light == 0) {
    for (uint32_t row = 0; row < rows.count(); ++row) light[row] = rows.solid_angle(row);
  }
  std::vector<uint32_t> first(rows.count() + 1);
  share_out(light, first);
  for (uint32_t row = 0; row < rows.count(); ++row) {
    const double cell = rows.solid_angle(row) / width;
    const double density = double(first[row + 1] - first[row]) / drawn_numbers / drawn_numbers / cell;
    const auto bits = [](double x) { return std::bit_cast<uint32_t>(static_cast<float>(x)); };
    data.quads[row] = glm::uvec4(first[row], bits(rows.polar_distance(row, 0)),
                                 bits(rows.polar_distance(row, 1)), bits(density));
  }
  data.quads[rows.count()] = glm::uvec4(first[rows.count()], 0, 0, 0);
}

void make_map(EnvironmentData& data, const scene::Environment& environment) {
  const size_t texels = environment.radiance.size(), width = environment.width;
  const size_t first = data.quads.size();
  data.quads.resize(first + texels);
  parallel_for(texels, 1 << 16, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const glm::vec3 radiance = layout::flush_tiny3(environment.radiance[i] * environment.strength);
      for (int c = 0; c < 3; ++c) data.quads[first + i][c] = std::bit_cast<uint32_t>(radiance[c]);
    }
  });
  make_distribution(data, [&](uint32_t x, uint32_t y) {
    const glm::uvec4& texel = data.quads[first + y * width + x];
    return luminance(
        {std::bit_cast<float>(texel.x), std::bit_cast<float>(texel.y), std::bit_cast<float>(texel.z)});
  });
}

void make_sky(EnvironmentData& data, const scene::Sky& sky) {
  layout::FrameRecord frame{};
  frame.sky_top = sky.top;
  frame.sky_horizon = sky.horizon;
  frame.sky_bottom = sky.bottom;
  make_distribution(data, [&](uint32_t, uint32_t y) {
    const auto up = static_cast<float>(std::cos(std::numbers::pi * (y + 0.5) / sky_rows));
    return std::max(luminance(layout::sky_radiance(frame, glm::vec3(0, up, 0))), 0.0);
  });
}

}  // namespace

EnvironmentData make_environment(const scene::Scene& scene) {
  EnvironmentData data;
  data.map = scene.environment.has_value();
  layout::EnvironmentRecord& record = data.record;
  record.width = data.map ? scene.environment->width : 1;
  record.height = data.map ? scene.environment->height : sky_rows;
  record.column_step = greatest_step(record.width);
  record.row_step = greatest_step(record.height + 1);
  const double turn = 0.5 + (data.map ? double(scene.environment->rotation) / 360 : 0);
  record.turn = static_cast<float>(turn - std::floor(turn));
  data.quads.resize(record.height + 2);
  if (data.map) {
    make_map(data, *scene.environment);
  } else {
    make_sky(data, frame_sky(scene));
  }
  return data;
}

EnvironmentTables::EnvironmentTables(Backend& backend, const scene::Scene& scene) {
  const EnvironmentData data = make_environment(scene);
  record = data.record;
  light = data.light;
  quads = make_buffer(backend, "environment_quads", 16, data.quads);
  cells = make_buffer(backend, "environment_cells", 4, data.cells);
  map = data.map ? 1 : 0;
}

}  // namespace lodestone::render
