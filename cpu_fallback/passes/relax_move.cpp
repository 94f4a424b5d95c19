// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/cpu_fallback/passes/texel_point.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/layout/relax.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class RelaxMove : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;
  using Kernel<Probe>::load;

  void operator()(uint32_t index) {
    const uint32_t texel = this->load(inner_texels_, push_.first + index);
    const uint32_t chart = this->load(relaxed_map_, texel).w;
    const uint32_t width = this->load(charts_, 2 * uint64_t(chart - 1)).y;
    const Site own = load_site(texel);
    center_ = as_vec3(this->load(now_, texel));
    scale_ = 0;
    const glm::vec2 own_rest = load_place_at_rest(texel);
    glm::vec2 rest = own_rest * -6.0f;
    glm::vec2 sum(0);
    float weights = 0;
    for (uint32_t k = 0; k < layout::relax_neighbors; ++k) {
      const uint32_t neighbor = layout::relax_neighbor(texel, width, k);
      const Site site = load_site(neighbor);
      around_[k] = site.at;
      rest = rest + load_place_at_rest(neighbor);
      points_[k] = as_vec3(this->load(now_, neighbor));
      scale_ = layout::max2(scale_, layout::largest_abs(layout::flush_tiny3(points_[k] - center_)));
      const float weight = own.weight + (site.face == layout::no_index ? own.weight : site.weight);
      sum = sum + site.at * weight;
      weights = weights + weight;
    }
    // Where the atlas has the texel beside the mean of its neighbours, to undo a fold, that is no way to go.
    const glm::vec2 mean = glm::vec2(sum.x / weights, sum.y / weights) - own.at;
    glm::vec2 way = (mean - rest * 0.16666667f) * layout::relax_gain;
    if (!is_long(way) || !(scale_ > 0)) return;
    for (glm::vec3& point : points_) point = layout::relax_seen(point, center_, scale_);
    // First the place where it is, then others.
    float least = 0;
    glm::vec2 to = own.at;
    for (uint32_t i = 0; i <= layout::relax_attempts && is_long(way); ++i) {
      if (i > 0) {
        to = own.at + way;
        way = way * 0.5f;
        if (!keeps_lattice(to)) continue;
      }
      const Place place = find(own.face, to);
      if (place.face == layout::no_index) continue;
      const float error = error_round(to, own.face, seen(point_at(positions_, place)));
      if (i == 0) {
        least = error;
      } else if (error < least) {
        put(texel, chart, own, to, place);
        return;
      }
    }
  }

 private:
  struct Site {
    glm::vec2 at;
    uint32_t face;
    float weight;
  };
  struct Place {
    uint32_t face = layout::no_index, triangle = 0;
    glm::vec2 at{0};  // barycentrics 1 and 2
  };

  Site load_site(uint32_t texel) {
    const glm::uvec4 site = this->load(sites_, texel);
    return {{layout::uintBitsToFloat(site.x), layout::uintBitsToFloat(site.y)},
            site.z,
            layout::uintBitsToFloat(site.w)};
  }

  glm::vec2 load_place_at_rest(uint32_t texel) {
    const glm::uvec4 site = this->load(map_sites_, texel);
    return {layout::uintBitsToFloat(site.x), layout::uintBitsToFloat(site.y)};
  }

  glm::vec2 load_point(uint32_t p) {
    return {layout::uintBitsToFloat(this->load(map_points_, 2 * uint64_t(p))),
            layout::uintBitsToFloat(this->load(map_points_, 2 * uint64_t(p) + 1))};
  }

  glm::vec3 point_at(const Quads& vertices, const Place& place) {
    const glm::uvec4 corners = this->load(triangles_, place.triangle);
    return texel_point(*this, vertices, corners,
                       {0, layout::floatBitsToUint(place.at.x), layout::floatBitsToUint(place.at.y), 0});
  }

  void put(uint32_t texel, uint32_t chart, const Site& own, const glm::vec2& to, const Place& place) {
    this->store(
        relaxed_map_, texel,
        {place.triangle, layout::floatBitsToUint(place.at.x), layout::floatBitsToUint(place.at.y), chart});
    this->store(sites_, texel,
                {layout::floatBitsToUint(to.x), layout::floatBitsToUint(to.y), place.face,
                 layout::floatBitsToUint(own.weight)});
    this->store(now_, texel, as_bits(point_at(positions_, place), 0));
    this->store(was_, texel, as_bits(point_at(rest_positions_, place), 0));
  }

  static bool is_long(const glm::vec2& step) {
    return layout::max2(layout::abs1(step.x), layout::abs1(step.y)) >= layout::relax_least_step;
  }
  glm::vec3 seen(const glm::vec3& p) const { return layout::relax_seen(p, center_, scale_); }

  // Whether the triangles of the lattice round the texel are all of an area, the right way round.
  bool keeps_lattice(const glm::vec2& to) const {
    for (uint32_t k = 0; k < layout::relax_neighbors; ++k) {
      if (!(layout::relax_side(to, around_[k], around_[k == 5 ? 0 : k + 1]) >= layout::relax_least_area))
        return false;
    }
    return true;
  }

  // Of the triangles round the texel, if it were at a place of the rectangle, and there `center` of the
  // surface, seen as the ring is.
  float error_round(const glm::vec2& at, uint32_t face, const glm::vec3& center) {
    float sum = 0;
    for (uint32_t k = 0; k < layout::relax_neighbors; ++k) {
      const uint32_t n = k == 5 ? 0 : k + 1;
      const Place middle = find(face, (at + around_[k] + around_[n]) * 0.33333333f);
      if (middle.face == layout::no_index) continue;
      sum = sum + layout::relax_error(center, points_[k], points_[n], seen(point_at(positions_, middle)));
    }
    return sum;
  }

  // What the map has at a place of the rectangle, sought from a face on.
  Place find(uint32_t face, const glm::vec2& to) {
    Place place;
    for (uint32_t i = 0; i < layout::relax_walk; ++i) {
      const glm::uvec4 corners = this->load(map_faces_, 2 * uint64_t(face)),
                       beside = this->load(map_faces_, 2 * uint64_t(face) + 1);
      const glm::vec2 p0 = load_point(corners.x), p1 = load_point(corners.y), p2 = load_point(corners.z);
      const glm::vec3 side(layout::relax_side(to, p1, p2), layout::relax_side(to, p2, p0),
                           layout::relax_side(to, p0, p1));
      if (side.x >= 0 && side.y >= 0 && side.z >= 0) {
        const float all = side.x + side.y + side.z;
        if (!(all > 0)) return place;
        place.face = face;
        place.triangle = corners.w;
        place.at = on_triangle({side.x / all, side.y / all, side.z / all}, beside.w);
        return place;
      }
      // Over the edge that it is farthest outside of. Edge k runs from corner k to the next, so it is the
      // one opposite to corner k + 2.
      face = side.z <= side.x && side.z <= side.y ? beside.x : side.x <= side.y ? beside.y : beside.z;
      if (face == layout::no_index) return place;
    }
    return place;
  }

  glm::vec2 on_triangle(const glm::vec3& in_face, uint32_t piece) {
    glm::vec2 at(in_face.y, in_face.z);
    if (piece != layout::no_index) {
      const uint64_t first = 6 * uint64_t(piece);
      const auto corner = [&](uint32_t word) {
        return layout::uintBitsToFloat(this->load(map_pieces_, first + word));
      };
      at.x = corner(0) * in_face.x + corner(2) * in_face.y + corner(4) * in_face.z;
      at.y = corner(1) * in_face.x + corner(3) * in_face.y + corner(5) * in_face.z;
    }
    at.x = layout::saturate(at.x);
    at.y = layout::min2(at.y, 1.0f - at.x);
    return at;
  }

  Words inner_texels_ = this->words(0);
  Quads charts_ = this->quads(1), triangles_ = this->quads(2), positions_ = this->quads(3),
        rest_positions_ = this->quads(4), map_faces_ = this->quads(5);
  Words map_points_ = this->words(6), map_pieces_ = this->words(7);
  Quads relaxed_map_ = this->quads(8), sites_ = this->quads(9), now_ = this->quads(10),
        was_ = this->quads(11), map_sites_ = this->quads(12);
  layout::RelaxPush push_ = this->template push<layout::RelaxPush>();
  // Of the texel at hand: where its neighbours are in the rectangle, and on the surface, seen from it.
  glm::vec2 around_[layout::relax_neighbors];
  glm::vec3 points_[layout::relax_neighbors];
  glm::vec3 center_{0};
  float scale_ = 0;
};

LODESTONE_BLOCK_FUNCTION(static, relax_move, RelaxMove)

}  // namespace

void relax_move(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 1024, relax_move_block);
}

}  // namespace lodestone::cpu_fallback
