// SPDX-License-Identifier: MIT
// What the lips hide: two rows of teeth in their gums, and a tongue.
#include <array>
#include <cmath>

#include "lodestone/scene/builtin/head_parts.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;
constexpr int teeth_a_side = 6;
constexpr uint32_t tooth_columns = 12, tooth_rows = 2 * teeth_a_side * 8 + 1;
constexpr uint32_t gum_columns = 10, gum_rows = 2 * teeth_a_side * 5 + 1;

// Thickness of a tube with round ends; `along` from 0 to 1, `cap` the share of the length that an end takes.
float round_ends(float along, float cap) {
  const float x = std::min({along, 1 - along, cap}) / cap;
  return std::sqrt(std::max(1 - (1 - x) * (1 - x), 0.0f));
}

// A row of teeth in its gum. Both follow the face at a constant depth, for so do the lips: whatever the
// expression, the row is as wide as the mouth and as far behind it everywhere.
struct Arch {
  float depth;                // of the middle of the teeth behind the skin
  float thickness;            // half of a tooth's
  float edge, gum;            // y, in the middle, of the free edges and of the border of the gum
  float edge_bend, gum_bend;  // how much they rise, times the square of the azimuth
  float gum_end;              // y of the far border of the gum
  std::array<float, teeth_a_side + 1> joint;  // azimuth between two teeth, from the middle outwards
  std::array<float, teeth_a_side> shorter;    // the tooth than the row says
};
constexpr Arch upper_arch = {0.086f,
                             0.030f,
                             -0.604f,
                             -0.462f,
                             0.50f,
                             0.28f,
                             -0.36f,
                             {0, 0.116f, 0.210f, 0.300f, 0.385f, 0.465f, 0.555f},
                             {0, 0.014f, 0.002f, 0.010f, 0.012f, 0.016f}};
constexpr Arch lower_arch = {0.134f,
                             0.026f,
                             -0.584f,
                             -0.680f,
                             0.52f,
                             0.40f,
                             -0.72f,
                             {0, 0.086f, 0.174f, 0.265f, 0.355f, 0.445f, 0.535f},
                             {0.004f, 0, 0.002f, 0.006f, 0.010f, 0.014f}};

// A cross-section of an arch.
struct Slice {
  glm::vec3 skin, outward;  // the face in front of it at the height of the mouth, and away from it, level
  float azimuth;
  float within;   // the tooth, from -1 to 1
  float shorter;  // this tooth
};

Slice slice_at(const Arch& arch, float along) {
  const float x = glm::clamp(along, 0.0f, 1.0f) * (2 * teeth_a_side);
  const int tooth = std::min(int(x), 2 * teeth_a_side - 1);
  const int k = tooth < teeth_a_side ? teeth_a_side - 1 - tooth : tooth - teeth_a_side;
  const float side = tooth < teeth_a_side ? -1.0f : 1.0f;
  const float share = side < 0 ? 1 - (x - float(tooth)) : x - float(tooth);
  Slice slice;
  slice.within = 2 * share - 1;
  // Samples gather where two teeth meet.
  slice.within = std::sin(0.5f * pi * slice.within);
  slice.azimuth =
      side * glm::mix(arch.joint[size_t(k)], arch.joint[size_t(k) + 1], 0.5f + 0.5f * slice.within);
  slice.shorter = arch.shorter[size_t(k)];
  const auto face = [](float azimuth) { return head_point({azimuth, mouth_line(0).elevation}); };
  slice.skin = face(slice.azimuth);
  const glm::vec3 across = face(slice.azimuth + 0.02f) - face(slice.azimuth - 0.02f);
  slice.outward = glm::normalize(glm::vec3(-across.z, 0, across.x));
  return slice;
}

float squared_off(float x) {
  return std::copysign(std::pow(std::abs(x), 0.6f), x);
}

glm::vec3 arch_point(const Slice& slice, float y, float behind) {
  const glm::vec3 p = slice.skin - slice.outward * behind;
  return {p.x, y, p.z};
}

// The row as one bar: pillows with a groove between two, rounded at the corners of the free edge.
glm::vec3 tooth_point(const Arch& arch, const Slice& slice, float along, float angle) {
  const float bend = slice.azimuth * slice.azimuth, up = arch.gum > arch.edge ? 1.0f : -1.0f;
  const float corner = std::pow(std::abs(slice.within), 6.0f);
  const float edge = arch.edge + arch.edge_bend * bend + up * (slice.shorter + 0.022f * corner);
  const float root = arch.gum + arch.gum_bend * bend + up * 0.04f;
  const float end = round_ends(along, 0.04f);
  const float thick = arch.thickness * end * (1 - 0.45f * corner - 0.10f * slice.within * slice.within);
  const float c = squared_off(std::cos(angle)), s = squared_off(std::sin(angle));
  // Thinner towards the edge.
  const float wedge = 1 - 0.30f * glm::smoothstep(0.0f, 1.0f, -up * c);
  return arch_point(slice, glm::mix(edge, root, 0.5f + 0.5f * up * c), arch.depth - thick * wedge * s);
}

// Its border dips between two teeth.
glm::vec3 gum_point(const Arch& arch, const Slice& slice, float along, float angle) {
  const float bend = slice.azimuth * slice.azimuth, up = arch.gum > arch.edge ? 1.0f : -1.0f;
  const float dip = slice.within * slice.within;
  const float border = arch.gum + arch.gum_bend * bend + up * (slice.shorter - 0.018f * dip + 0.006f);
  const float end = round_ends(along, 0.04f);
  const float c = squared_off(std::cos(angle)), s = squared_off(std::sin(angle));
  const float low = 0.5f + 0.5f * up * c;  // 0 at the border
  const float thick = end * (arch.thickness + 0.006f + 0.012f * low - 0.006f * dip);
  // Deeper where it ends, so as to stay inside the chin.
  return arch_point(slice, glm::mix(border, arch.gum_end, low), arch.depth + 0.03f * low - thick * s);
}

glm::vec3 tooth_color(const Arch& arch, const Slice& slice, float y) {
  const float deep = glm::smoothstep(0.85f, 1.0f, std::abs(slice.within));
  const glm::vec3 ivory(0.88f, 0.84f, 0.76f), root(0.80f, 0.68f, 0.54f), groove(0.58f, 0.43f, 0.34f);
  const float up = (y - arch.edge) / (arch.gum - arch.edge);
  return glm::mix(glm::mix(ivory, root, 0.7f * glm::smoothstep(0.5f, 1.1f, up)), groove, deep);
}

// The middle line of the tongue, from its root to its tip.
glm::vec3 tongue_spine(float along, float out) {
  const glm::vec3 in(0, -0.66f + 0.07f * bump(along - 0.45f), glm::mix(0.12f, 0.655f, along));
  const float over = glm::smoothstep(0.45f, 1.0f, along);
  const glm::vec3 stretched(0, -0.63f + 0.135f * glm::smoothstep(0.0f, 0.55f, along) - 0.20f * over * over,
                            glm::mix(0.12f, 1.16f, along) - 0.06f * over * over);
  return glm::mix(in, stretched, out);
}

glm::vec3 tongue_point(float along, float angle, const Expression& e) {
  const glm::vec3 spine = tongue_spine(along, e.tongue);
  const glm::vec3 forward =
      glm::normalize(tongue_spine(along + 0.01f, e.tongue) - tongue_spine(along - 0.01f, e.tongue));
  const glm::vec3 side(1, 0, 0), up = glm::cross(forward, side);
  const float end = round_ends(along, 0.35f);
  const float c = std::cos(angle), s = std::sin(angle);
  const float width = 0.15f * glm::mix(0.15f, 1.0f, end);
  const float groove = s > 0 ? 0.022f * bump(c / 0.45f) * end : 0;
  return spine + side * (width * c) + up * (0.050f * end * s - groove);
}

void sample(const ZippedTube& tube, std::vector<glm::vec3>& out,
            const std::function<glm::vec3(float along, float angle)>& point) {
  for (const ZippedTube::Sample& sample : tube.samples())
    out.push_back(snap(point(float(sample.row) / float(tube.rows() - 1),
                             2 * pi * float(sample.column) / float(tube.columns()))));
}

}  // namespace

Mesh head_teeth(uint32_t material) {
  Mesh mesh;
  mesh.name = "teeth";
  struct Row {
    const Arch& arch;
    std::vector<glm::vec3> positions;  // with the jaw shut
  };
  std::array<Row, 2> rows = {{{upper_arch, {}}, {lower_arch, {}}}};
  uint32_t first = 0;
  for (Row& row : rows) {
    const ZippedTube teeth(tooth_columns, tooth_rows, first);
    const ZippedTube gum(gum_columns, gum_rows, first + uint32_t(teeth.samples().size()));
    first += uint32_t(teeth.samples().size() + gum.samples().size());
    add_grid(mesh, teeth.chart());
    add_grid(mesh, gum.chart());
    std::vector<Slice> slices;
    for (uint32_t k = 0; k < tooth_rows; ++k)
      slices.push_back(slice_at(row.arch, float(k) / float(tooth_rows - 1)));
    sample(teeth, row.positions, [&](float along, float angle) {
      const Slice& slice = slices[size_t(std::lround(along * float(tooth_rows - 1)))];
      const glm::vec3 p = tooth_point(row.arch, slice, along, angle);
      mesh.colors.emplace_back(tooth_color(row.arch, slice, p.y), 1);
      return p;
    });
    sample(gum, row.positions, [&](float along, float angle) {
      mesh.colors.emplace_back(0.60f, 0.20f, 0.19f, 1);
      return gum_point(row.arch, slice_at(row.arch, along), along, angle);
    });
  }
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression& e) {
    std::vector<glm::vec3> out = rows[0].positions;
    for (const glm::vec3& p : rows[1].positions) out.push_back(snap(turn_jaw(p, 1, e)));
    return out;
  });
  return mesh;
}

// It sees so little that four samples of it are mostly noise; less of it is calmer.
Image mouth_shade() {
  Image image;
  image.name = "mouth";
  image.width = image.height = 1;
  image.rgba = {160, 0, 0, 255};
  return image;
}

Mesh head_tongue(uint32_t material) {
  Mesh mesh;
  mesh.name = "tongue";
  const ZippedTube tube(24, 29);
  add_grid(mesh, tube.chart());
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression& e) {
    std::vector<glm::vec3> out;
    sample(tube, out,
           [&](float along, float angle) { return turn_jaw(tongue_point(along, angle, e), 1, e); });
    return out;
  });
  return mesh;
}

}  // namespace lodestone::scene::builtin
