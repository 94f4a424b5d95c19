// SPDX-License-Identifier: MIT
// A fractal height field of 3 x 2 charts whose sizes are unequal and no powers of two, with a wave travelling
// through it: the test of chart borders, odd pyramids and moving samples.
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/scene/builtin/noise.h"
#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/builtin/staging.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

// Charts side by side and one behind the other, by their samples; neighbours share a column or row.
struct Layout {
  std::vector<uint32_t> widths = {97, 64, 50}, heights = {61, 33};
  float spacing = 0.05f;
  uint32_t octaves = 6;

  static uint32_t samples(const std::vector<uint32_t>& charts) {
    uint32_t sum = 1;
    for (const uint32_t chart : charts) sum += chart - 1;
    return sum;
  }
};

// As wide as the small one, square, as fine as its quads are, and detailed down to them.
Layout large_layout(uint32_t quads) {
  constexpr uint32_t largest_chart = 1024;  // quads
  Layout layout;
  const float width = layout.spacing * float(Layout::samples(layout.widths) - 1);
  const uint32_t charts = (quads + largest_chart - 1) / largest_chart;
  layout.widths.clear();
  for (uint32_t i = 0; i < charts; ++i)
    layout.widths.push_back(quads * (i + 1) / charts - quads * i / charts + 1);
  layout.heights = layout.widths;
  for (uint32_t finer = 210; finer < quads; finer *= 2) ++layout.octaves;
  layout.spacing = width / float(quads);
  return layout;
}

// Ridged fractal noise: mountains with crests, flat valleys.
float height_at(glm::vec2 p, uint32_t octaves) {
  float height = 0, amplitude = 1.1f, frequency = 0.45f;
  for (uint32_t octave = 0; octave < octaves; ++octave) {
    const float n = 1 - std::abs(2 * value_noise(p.x * frequency, p.y * frequency, octave) - 1);
    height += amplitude * n * n;
    amplitude *= 0.42f;
    frequency *= 2.1f;
  }
  return height - 0.6f;
}

glm::vec4 ground_color(float height, float slope) {
  const glm::vec3 grass(0.16f, 0.26f, 0.08f), rock(0.30f, 0.26f, 0.22f), snow(0.85f, 0.87f, 0.9f);
  const glm::vec3 ground = glm::mix(grass, rock, glm::smoothstep(0.25f, 0.6f, slope));
  return glm::vec4(glm::mix(ground, snow, glm::smoothstep(0.55f, 0.8f, height)), 1);
}

Mesh terrain_mesh(const Layout& layout) {
  constexpr uint64_t rows_a_task = 16;
  const uint32_t columns = Layout::samples(layout.widths), rows = Layout::samples(layout.heights);
  Mesh mesh;
  mesh.name = "terrain";
  mesh.positions.resize(size_t(columns) * rows);
  mesh.texcoords[0].resize(size_t(columns) * rows);
  // Columns run along +X and rows along -Z, so that columns x rows points up.
  parallel_for(rows, rows_a_task, [&](uint64_t begin, uint64_t end) {
    for (auto y = static_cast<uint32_t>(begin); y < end; ++y)
      for (uint32_t x = 0; x < columns; ++x) {
        const glm::vec2 p((float(x) - 0.5f * float(columns - 1)) * layout.spacing,
                          (0.5f * float(rows - 1) - float(y)) * layout.spacing);
        const size_t sample = size_t(y) * columns + x;
        mesh.positions[sample] = snap(glm::vec3(p.x, height_at(p, layout.octaves), p.y));
        mesh.texcoords[0][sample] =
            snap(glm::vec2(float(x) / float(columns - 1), float(y) / float(rows - 1)));
      }
  });
  uint32_t first_row = 0;
  for (const uint32_t height : layout.heights) {
    uint32_t first_column = 0;
    for (const uint32_t width : layout.widths) {
      Grid grid{width, height, 0, {}};
      for (uint32_t y = first_row; y < first_row + height; ++y)
        for (uint32_t x = first_column; x < first_column + width; ++x)
          grid.vertices.push_back(y * columns + x);
      add_grid(mesh, std::move(grid));
      first_column += width - 1;
    }
    first_row += height - 1;
  }
  return mesh;
}

// A standing wave; two of them a quarter period apart, weighted by cosine and sine of time, travel.
void add_wave(Mesh& mesh, const std::string& name, float phase) {
  std::vector<glm::vec3> posed = mesh.positions;
  for (glm::vec3& p : posed) p = snap(p + glm::vec3(0, 0.06f * std::sin(1.8f * p.x + 0.9f * p.z + phase), 0));
  add_target(mesh, morph_target(mesh, name, posed));
}

Mesh coloured_mesh(const Layout& layout, uint32_t material) {
  Mesh mesh = terrain_mesh(layout);
  add_part(mesh, 0, material);
  mesh.normals = snapped_normals(mesh, mesh.positions);
  for (size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.colors.push_back(ground_color(mesh.positions[v].y, 1 - mesh.normals[v].y));
  return mesh;
}

void add_valley(Scene& scene) {
  Camera camera;
  camera.name = "Valley";
  camera.yfov = 0.65f;
  add_camera(scene, camera, {1.5f, 3.6f, 6.5f}, {0, 0.1f, 0});
  Light sun;
  sun.name = "Sun";
  sun.kind = Light::Kind::directional;
  sun.color = {1, 0.93f, 0.8f};
  sun.intensity = 3;
  add_light(scene, sun, {-4, 3, 2}, {0, 0, 0});
  scene.sky = Sky{{0.25f, 0.42f, 0.75f}, {0.65f, 0.7f, 0.75f}, {0.15f, 0.14f, 0.12f}};
}

}  // namespace

Scene make_large_terrain(uint32_t quads) {
  Scene scene;
  const uint32_t ground = add_material(scene, "ground", glm::vec3(1), 0.95f);
  add_mesh(scene, coloured_mesh(large_layout(quads), ground));
  add_valley(scene);
  return scene;
}

Scene make_terrain() {
  Scene scene;
  const uint32_t ground = add_material(scene, "ground", glm::vec3(1), 0.95f);
  Mesh mesh = coloured_mesh({}, ground);
  add_wave(mesh, "waveCosine", 0);
  add_wave(mesh, "waveSine", 1.5707963f);
  const uint32_t node = add_mesh(scene, std::move(mesh));
  add_valley(scene);

  Animation animation;
  animation.name = "Wave";
  std::vector<float> times;
  std::vector<std::vector<float>> keys;
  constexpr int steps = 16;
  for (int k = 0; k <= steps; ++k) {
    const float angle = 6.2831853f * float(k % steps) / steps;  // the last key is the first
    times.push_back(2.0f * float(k) / steps);
    keys.push_back({snap(std::cos(angle)), snap(std::sin(angle))});
  }
  animation.channels.push_back(weight_keys(node, Channel::Interpolation::linear, times, keys));
  scene.animations.push_back(std::move(animation));
  return scene;
}

}  // namespace lodestone::scene::builtin
