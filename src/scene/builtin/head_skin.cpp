// SPDX-License-Identifier: MIT
#include "lodestone/scene/builtin/head_skin.h"

#include <cmath>
#include <span>

#include "lodestone/base/parallel.h"
#include "lodestone/scene/builtin/head_parts.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;

// Which sample of the front lies where: azimuth by column, elevation by row; the knots are the borders of the
// holes.
constexpr std::array<glm::vec2, 8> column_knots = {{{0, -1.05f},
                                                    {9, -0.83f},
                                                    {28, -0.27f},
                                                    {43, -0.06f},
                                                    {53, 0.06f},
                                                    {68, 0.27f},
                                                    {87, 0.83f},
                                                    {96, 1.05f}}};
constexpr std::array<glm::vec2, 7> row_knots = {
    {{0, -1.36f}, {14, -0.98f}, {22, -0.74f}, {38, -0.27f}, {50, -0.10f}, {74, 0.47f}, {84, 0.85f}}};
constexpr glm::ivec3 cells(96, 84, 34);
constexpr glm::ivec2 right_eye_lo(9, 50), right_eye_hi(43, 74);
constexpr glm::ivec2 left_eye_lo(53, 50), left_eye_hi(87, 74);
constexpr glm::ivec2 mouth_lo(21, 22), mouth_hi(75, 38);

float ramp(std::span<const glm::vec2> knots, float x) {
  size_t k = 1;
  while (k + 1 < knots.size() && x > knots[k].x) ++k;
  return glm::mix(knots[k - 1].y, knots[k].y, (x - knots[k - 1].x) / (knots[k].x - knots[k - 1].x));
}

// The azimuth of the wall above the border point (x, z) of the lattice's plan.
float wall_azimuth(float x, float z) {
  const float front = column_knots.back().y;
  if (z == float(cells.z)) return ramp(column_knots, x);
  if (z == 0) return (x < 0.5f * cells.x ? -pi : pi) - (pi - 2.0f) * (2 * x / cells.x - 1);
  const float side = glm::mix(front, 2.0f, 1 - z / cells.z);
  return x == 0 ? -side : side;
}

}  // namespace

glm::vec3 skin_color(Aim rest) {
  const Aim aim{std::abs(rest.azimuth), rest.elevation};
  glm::vec3 color(0.80f, 0.40f, 0.245f);
  const glm::vec3 flush(0.76f, 0.22f, 0.15f);
  const float cheek = bump(aim, {0.50f, -0.26f}, {0.34f, 0.28f});
  const float nose = bump(aim, {0, -0.12f}, {0.17f, 0.20f});
  const float chin = bump(aim, {0, -0.80f}, {0.25f, 0.20f});
  color = glm::mix(color, flush, 0.60f * cheek + 0.50f * nose + 0.15f * chin);
  const float socket = bump(aim, {0.40f, 0.12f}, {0.36f, 0.34f});
  return glm::mix(color, glm::vec3(0.66f, 0.31f, 0.24f), 0.35f * socket);
}

HeadSkin::HeadSkin() : lattice_(cells) {
  for (const glm::ivec3& point : lattice_.points()) aims_.push_back(lattice_aim(point));
  vertex_count_ = uint32_t(aims_.size());
  for (const BoxLattice::Face face : BoxLattice::faces)
    if (face != BoxLattice::Face::front) grids_.push_back(lattice_.chart(face));
  add_front();
  aims_.resize(vertex_count_);
  lay_lids(eyes_[0], -1);
  lay_lids(eyes_[1], 1);
  lay_lips(mouth_);
  points_.resize(vertex_count_);
  normals_.resize(vertex_count_);
  parallel_for(vertex_count_, 256, [&](uint64_t begin, uint64_t end) {
    for (uint64_t v = begin; v < end; ++v) {
      points_[v] = head_point(aims_[v]);
      normals_[v] = head_normal(points_[v]);
    }
  });
}

Aim HeadSkin::lattice_aim(glm::ivec3 point) const {
  const float elevation = ramp(row_knots, float(point.y));
  const glm::vec2 plan = 2.0f * glm::vec2(point.x, point.z) / glm::vec2(cells.x, cells.z) - 1.0f;
  const float m = std::max(std::abs(plan.x), std::abs(plan.y));
  if (m == 1) return {wall_azimuth(float(point.x), float(point.z)), elevation};
  // A cap: squares about its centre become circles about the pole.
  const float pole = point.y == 0 ? -0.5f * pi : 0.5f * pi;
  if (m == 0) return {0, pole};
  const glm::vec2 border = (plan / m * 0.5f + 0.5f) * glm::vec2(cells.x, cells.z);
  const glm::vec2 clamped(std::abs(plan.x) == m ? std::round(border.x) : border.x,
                          std::abs(plan.y) == m ? std::round(border.y) : border.y);
  return {wall_azimuth(clamped.x, clamped.y), glm::mix(pole, elevation, m)};
}

void HeadSkin::add_front() {
  const auto block = [&](int x0, int y0, int x1, int y1) {
    grids_.push_back(lattice_.chart(BoxLattice::Face::front, {x0, y0}, {x1, y1}));
  };
  block(0, 0, cells.x, mouth_lo.y);
  block(0, mouth_lo.y, mouth_lo.x, mouth_hi.y);
  block(mouth_hi.x, mouth_lo.y, cells.x, mouth_hi.y);
  block(0, mouth_hi.y, cells.x, right_eye_lo.y);
  block(0, right_eye_lo.y, right_eye_lo.x, right_eye_hi.y);
  block(right_eye_hi.x, left_eye_lo.y, left_eye_lo.x, left_eye_hi.y);
  block(left_eye_hi.x, left_eye_lo.y, cells.x, left_eye_hi.y);
  block(0, left_eye_hi.y, cells.x, cells.y);
  eyes_[0] = add_ring(right_eye_lo, right_eye_hi, eye_ring_rows);
  eyes_[1] = add_ring(left_eye_lo, left_eye_hi, eye_ring_rows);
  mouth_ = add_ring(mouth_lo, mouth_hi, mouth_ring_rows);
}

HeadSkin::Ring HeadSkin::add_ring(glm::ivec2 lo, glm::ivec2 hi, uint32_t rows) {
  Ring ring;
  ring.lo = lo;
  ring.hi = hi;
  ring.rows = rows;
  ring.first_vertex = vertex_count_;
  const auto visit = [&](int x, int y) { ring.border.push_back(lattice_.vertex({x, y, cells.z})); };
  for (int x = lo.x; x < hi.x; ++x) visit(x, lo.y);
  for (int y = lo.y; y < hi.y; ++y) visit(hi.x, y);
  for (int x = hi.x; x > lo.x; --x) visit(x, hi.y);
  for (int y = hi.y; y > lo.y; --y) visit(lo.x, y);
  const uint32_t around = uint32_t(ring.border.size());
  vertex_count_ += around * (rows - 1);

  Grid wall{around + 1, rows, 0, {}};
  for (uint32_t row = 0; row < rows; ++row)
    for (uint32_t column = 0; column <= around; ++column)
      wall.vertices.push_back(ring_vertex(ring, column % around, row));
  grids_.push_back(std::move(wall));

  // The cap is the hole's own piece of the front with the ring's last row as its border.
  Grid cap = lattice_.chart(BoxLattice::Face::front, lo, hi);
  for (uint32_t& vertex : cap.vertices)
    for (uint32_t column = 0; column < around; ++column)
      if (vertex == ring.border[column]) {
        vertex = ring_vertex(ring, column, rows - 1);
        break;
      }
  grids_.push_back(std::move(cap));
  return ring;
}

uint32_t HeadSkin::ring_vertex(const Ring& ring, uint32_t column, uint32_t row) const {
  const uint32_t around = uint32_t(ring.border.size());
  return row == 0 ? ring.border[column] : ring.first_vertex + (row - 1) * around + column;
}

HeadSkin::Seam HeadSkin::ring_seam(const Ring& ring, uint32_t column) const {
  const uint32_t around = uint32_t(ring.border.size()), half = around / 2;
  // Columns begin at a corner of the hole; the corner of the slit lies half its height further back.
  const uint32_t u = (column + uint32_t(ring.hi.y - ring.lo.y) / 2) % around;
  const bool upper = u > half;
  return {float(upper ? around - u : u) / float(half), upper};
}

glm::vec3 HeadSkin::face_point(uint32_t vertex, Aim aim) const {
  return aim == aims_[vertex] ? points_[vertex] : head_point(aim);
}

glm::vec3 HeadSkin::face_normal(uint32_t vertex, Aim aim, glm::vec3 point) const {
  return aim == aims_[vertex] ? normals_[vertex] : head_normal(point);
}

glm::vec3 HeadSkin::posed_vertex(uint32_t vertex, const Expression& e, float lift) const {
  const Aim rest = aims_[vertex], aim = rest + skin_slide(rest, e);
  glm::vec3 p = face_point(vertex, aim);
  const float swell = skin_swell(rest, e) + lift;
  if (swell != 0) p += swell * face_normal(vertex, aim, p);
  return turn_jaw(p, jaw_share(rest), e);
}

std::vector<glm::vec3> HeadSkin::posed(const Expression& e) const {
  std::vector<glm::vec3> out(vertex_count_);
  for (uint32_t v = 0; v < lattice_.points().size(); ++v) out[v] = posed_vertex(v, e);
  pose_eye(eyes_[0], -1, e, out);
  pose_eye(eyes_[1], 1, e, out);
  pose_mouth(mouth_, e, out);
  pose_cap(eyes_[0], out);
  pose_cap(eyes_[1], out);
  pose_cap(mouth_, out);
  for (glm::vec3& p : out) p = snap(p);
  return out;
}

// Fills a cap between the vertices of its border: Coons' patch.
void HeadSkin::pose_cap(const Ring& ring, std::vector<glm::vec3>& out) const {
  const glm::ivec2 size = ring.hi - ring.lo;
  const uint32_t last = ring.rows - 1;
  const auto at = [&](uint32_t column) { return out[ring_vertex(ring, column, last)]; };
  const uint32_t w = uint32_t(size.x), h = uint32_t(size.y), around = uint32_t(ring.border.size());
  const glm::vec3 corners[4] = {at(0), at(w), at(w + h),
                                at(2 * w + h)};  // counter-clockwise from the low one
  for (uint32_t y = 1; y < h; ++y)
    for (uint32_t x = 1; x < w; ++x) {
      const float s = float(x) / float(w), t = float(y) / float(h);
      const glm::vec3 rows = glm::mix(at(x), at(2 * w + h - x), t);
      const glm::vec3 columns = glm::mix(at((around - y) % around), at(w + y), s);
      const glm::vec3 both =
          glm::mix(glm::mix(corners[0], corners[1], s), glm::mix(corners[3], corners[2], s), t);
      out[lattice_.vertex({ring.lo.x + int(x), ring.lo.y + int(y), cells.z})] = rows + columns - both;
    }
}

// Colours follow the edge loops, so that lips and lid edges are crisp.
std::vector<glm::vec4> HeadSkin::colors() const {
  std::vector<glm::vec4> out(vertex_count_);
  for (size_t v = 0; v < aims_.size(); ++v) out[v] = glm::vec4(skin_color(aims_[v]), 1);
  color_eye(eyes_[0], -1, out);
  color_eye(eyes_[1], 1, out);
  color_mouth(mouth_, out);
  return out;
}

Mesh head_skin(uint32_t material) {
  const HeadSkin skin;
  Mesh mesh;
  mesh.name = "skin";
  for (const Grid& grid : skin.grids()) add_grid(mesh, grid);
  add_part(mesh, 0, material);
  mesh.colors = skin.colors();
  sculpt(mesh, [&](const Expression& e) { return skin.posed(e); });
  for (const glm::vec3& p : mesh.positions) mesh.texcoords[0].push_back(snap(freckle_coordinates(aim_at(p))));
  return mesh;
}

}  // namespace lodestone::scene::builtin
