// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/collapse_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <numeric>

#include "lodestone/geometry_image/quad_order.h"
#include "lodestone/geometry_image/weld.h"

namespace lodestone::geometry_image {
namespace {

using layout::ChartRecord;
constexpr uint32_t none = layout::no_index;

uint32_t trailing_zeros(uint32_t x) {
  return static_cast<uint32_t>(std::countr_zero(x));
}

// A chart as a rectangle of quads.
struct Rectangle {
  explicit Rectangle(const ChartRecord& chart)
      : first(chart.first_texel), width(chart.width - 1), height(chart.height - 1), stride(chart.width) {
    square = static_cast<uint32_t>(std::min(std::bit_width(width - 1), std::bit_width(height - 1)));
  }
  uint32_t texel(uint32_t x, uint32_t y) const { return first + y * stride + x; }

  uint32_t first, width, height, stride;
  uint32_t square;  // level of the largest nodes that are squares (quad_order.h)
};

struct Place {
  uint32_t x, y;
};

// The texels of side 0..3 of a chart, corners included.
std::vector<Place> side_places(const Rectangle& r, uint32_t side) {
  const bool along_x = side < 2;
  std::vector<Place> places;
  for (uint32_t i = 0; i <= (along_x ? r.width : r.height); ++i) {
    const uint32_t other = side % 2 == 0 ? 0 : (along_x ? r.height : r.width);
    places.push_back(along_x ? Place{i, other} : Place{other, i});
  }
  return places;
}

// A texel by what it is made of: welded vertices and their shares.
struct Recipe {
  std::array<std::array<uint32_t, 2>, 3> parts;
  uint32_t texel;
};

Recipe recipe_of(const scene::Assembly& assembly, const std::vector<uint32_t>& welded, const Atlas& atlas,
                 uint32_t texel) {
  const glm::uvec4& entry = atlas.texel_map[texel];
  const float b1 = std::bit_cast<float>(entry.y), b2 = std::bit_cast<float>(entry.z);
  const std::array<float, 3> shares = {1.0f - b1 - b2, b1, b2};
  Recipe recipe{};
  recipe.texel = texel;
  for (int i = 0; i < 3; ++i) {
    const float share = shares[static_cast<size_t>(i)];
    recipe.parts[static_cast<size_t>(i)] =
        share == 0
            ? std::array<uint32_t, 2>{none, 0}
            : std::array<uint32_t, 2>{welded[assembly.triangles[entry.x][i]], std::bit_cast<uint32_t>(share)};
  }
  std::sort(recipe.parts.begin(), recipe.parts.end());
  return recipe;
}

class Maker {
 public:
  Maker(const scene::Assembly& assembly, const Atlas& atlas, const std::vector<bool>& kept)
      : assembly_(assembly), atlas_(atlas), kept_(kept) {
    for (const ChartRecord& chart : atlas.charts) rectangles_.emplace_back(chart);
  }

  CollapseMap make() {
    find_points();
    fix_corners();
    place_inner();
    place_borders();
    list_nodes();
    do settle();
    while (!find_steps());
    return write();
  }

 private:
  struct Node {
    uint32_t chart, level, x, y;  // of corner a
    uint32_t children[4] = {none, none, none, none};
    uint32_t parent = none;
    bool able = true;
    uint32_t step = 0;
  };

  bool resizes(size_t chart) const {
    return atlas_.charts[chart].kind != layout::chart_exact && (kept_.empty() || !kept_[chart]);
  }

  void find_points();
  void fix_corners();
  void place_inner();
  void place_borders();
  void place_side(const Rectangle& r, uint32_t side, std::vector<bool>& placed);
  void list_nodes();
  void settle();
  bool find_steps();
  bool is_able(const Node& node) const;
  void fix(uint32_t texel) { fixed_[points_[texel]] = true; }
  CollapseMap write() const;
  CoarseNode described(const Node& node) const;

  // Corners a b c d, and then what lies between: bottom, left, centre, right, top; none where it is a corner.
  std::array<uint32_t, 9> vertices(const Node& node) const {
    const Rectangle& r = rectangles_[node.chart];
    const uint32_t size = 1u << node.level, half = size / 2;
    const uint32_t x1 = std::min(node.x + size, r.width), y1 = std::min(node.y + size, r.height);
    const bool wide = node.x + half < x1, high = node.y + half < y1;
    const auto at = [&](uint32_t x, uint32_t y) { return r.texel(x, y); };
    const uint32_t xm = node.x + half, ym = node.y + half;
    return {at(node.x, node.y),
            at(x1, node.y),
            at(node.x, y1),
            at(x1, y1),
            wide ? at(xm, node.y) : none,
            high ? at(node.x, ym) : none,
            wide && high ? at(xm, ym) : none,
            high ? at(x1, ym) : none,
            wide ? at(xm, y1) : none};
  }

  const scene::Assembly& assembly_;
  const Atlas& atlas_;
  const std::vector<bool>& kept_;
  std::vector<Rectangle> rectangles_;
  std::vector<uint32_t> points_, parents_;
  std::vector<bool> fixed_;
  std::vector<Node> nodes_;  // children before their parents within a chart
};

void Maker::find_points() {
  points_.resize(atlas_.texel_map.size());
  std::iota(points_.begin(), points_.end(), 0u);
  parents_ = points_;
  const std::vector<uint32_t> welded = weld(assembly_);
  std::vector<Recipe> recipes;
  for (size_t c = 0; c < rectangles_.size(); ++c) {
    const Rectangle& r = rectangles_[c];
    for (uint32_t y = 0; y <= r.height; ++y) {
      for (uint32_t x = 0; x <= r.width; x += y == 0 || y == r.height ? 1 : r.width) {
        if (atlas_.texel_map[r.texel(x, y)].w != 0)
          recipes.push_back(recipe_of(assembly_, welded, atlas_, r.texel(x, y)));
      }
    }
  }
  std::sort(recipes.begin(), recipes.end(), [](const Recipe& a, const Recipe& b) {
    return a.parts != b.parts ? a.parts < b.parts : a.texel < b.texel;
  });
  for (size_t i = 1; i < recipes.size(); ++i) {
    if (recipes[i].parts == recipes[i - 1].parts) points_[recipes[i].texel] = points_[recipes[i - 1].texel];
  }
}

// Corners of charts stay, and so does whatever is not simply between two others on all borders it lies on.
void Maker::fix_corners() {
  fixed_.assign(points_.size(), false);
  std::vector<std::array<uint32_t, 2>> pairs;
  for (size_t c = 0; c < rectangles_.size(); ++c) {
    const Rectangle& r = rectangles_[c];
    if (!resizes(c)) {
      for (uint32_t i = 0; i < (r.width + 1) * (r.height + 1); ++i) fix(r.first + i);
      continue;
    }
    const uint32_t size = 1u << r.square;
    for (uint32_t y = 0; y < r.height + size; y += size) {
      for (uint32_t x = 0; x < r.width + size; x += size)
        fix(r.texel(std::min(x, r.width), std::min(y, r.height)));
    }
    for (uint32_t side = 0; side < 4; ++side) {
      uint32_t before = none;
      for (const Place& place : side_places(r, side)) {
        const uint32_t point = points_[r.texel(place.x, place.y)];
        if (before != none && before != point) {
          pairs.push_back({before, point});
          pairs.push_back({point, before});
        }
        before = point;
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (size_t i = 0; i < pairs.size();) {
    size_t end = i;
    while (end < pairs.size() && pairs[end][0] == pairs[i][0]) ++end;
    if (end - i != 2) fixed_[pairs[i][0]] = true;
    i = end;
  }
}

// To the next line that is left of twice as many, up in x and down in y: so the texels of a node end where
// its two triangles are those of a quad.
void Maker::place_inner() {
  for (size_t c = 0; c < rectangles_.size(); ++c) {
    if (!resizes(c)) continue;
    const Rectangle& r = rectangles_[c];
    for (uint32_t y = 1; y < r.height; ++y) {
      for (uint32_t x = 1; x < r.width; ++x) {
        const uint32_t step = 2u << std::min(trailing_zeros(x), trailing_zeros(y));
        const uint32_t to_x = std::min((x + step - 1) / step * step, r.width);
        parents_[r.texel(x, y)] = points_[r.texel(to_x, y / step * step)];
      }
    }
  }
}

// Border points follow the numbering of one chart beside them: of that whose side has the fewest texels
// twice, so that all its texels can follow, and of those the largest.
void Maker::place_borders() {
  struct Side {
    uint32_t repeats, length, chart, side;
  };
  std::vector<Side> sides;
  for (uint32_t c = 0; c < rectangles_.size(); ++c) {
    if (!resizes(c)) continue;
    const Rectangle& r = rectangles_[c];
    for (uint32_t side = 0; side < 4; ++side) {
      uint32_t repeats = 0, before = none;
      for (const Place& place : side_places(r, side)) {
        const uint32_t point = points_[r.texel(place.x, place.y)];
        repeats += point == before ? 1 : 0;
        before = point;
      }
      sides.push_back({repeats, side < 2 ? r.width : r.height, c, side});
    }
  }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.repeats != b.repeats ? a.repeats < b.repeats : a.length > b.length;
  });
  std::vector<bool> placed(points_.size(), false);
  for (const Side& side : sides) place_side(rectangles_[side.chart], side.side, placed);
}

void Maker::place_side(const Rectangle& r, uint32_t side, std::vector<bool>& placed) {
  const std::vector<Place> places = side_places(r, side);
  std::vector<uint32_t> line;
  for (const Place& place : places) line.push_back(points_[r.texel(place.x, place.y)]);
  // Runs between points that stay.
  for (uint32_t begin = 0; begin + 1 < line.size();) {
    uint32_t end = begin + 1;
    while (!fixed_[line[end]]) ++end;
    for (uint32_t i = begin + 1; i < end; ++i) {
      if (placed[line[i]] || line[i] == line[i - 1]) continue;
      uint32_t last = i;  // of equal ones
      while (line[last + 1] == line[i]) ++last;
      uint32_t best = i;
      for (uint32_t k = i; k <= last; ++k)
        if (trailing_zeros(k) > trailing_zeros(best)) best = k;
      const uint32_t step = 1u << trailing_zeros(best);
      if (best >= begin + step) {
        parents_[line[i]] = line[best - step];
      } else if (best + step <= end) {
        parents_[line[i]] = line[best + step];
      } else {
        fixed_[line[i]] = true;
      }
    }
    for (uint32_t i = begin + 1; i < end; ++i) placed[line[i]] = true;
    begin = end;
  }
}

void Maker::list_nodes() {
  for (uint32_t c = 0; c < rectangles_.size(); ++c) {
    if (!resizes(c)) continue;
    const Rectangle& r = rectangles_[c];
    size_t below = 0;
    uint32_t below_across = 0, below_along = 0;
    for (uint32_t level = 1; level <= r.square; ++level) {
      const uint32_t size = 1u << level;
      const uint32_t across = (r.width + size - 1) / size, along = (r.height + size - 1) / size;
      const size_t first = nodes_.size();
      for (uint32_t y = 0; y < along; ++y) {
        for (uint32_t x = 0; x < across; ++x) {
          Node node{c, level, x * size, y * size};
          for (uint32_t k = 0; level > 1 && k < 4; ++k) {
            const uint32_t cx = 2 * x + (k & 1), cy = 2 * y + (k >> 1);
            if (cx < below_across && cy < below_along)
              node.children[k] = static_cast<uint32_t>(below + size_t(cy) * below_across + cx);
            if (node.children[k] != none)
              nodes_[node.children[k]].parent = static_cast<uint32_t>(nodes_.size());
          }
          nodes_.push_back(node);
        }
      }
      below = first;
      below_across = across;
      below_along = along;
    }
  }
}

// Whether it is its two triangles, once all between its corners have collapsed.
bool Maker::is_able(const Node& node) const {
  for (uint32_t child : node.children)
    if (child != none && !nodes_[child].able) return false;
  const std::array<uint32_t, 9> v = vertices(node);
  std::array<uint32_t, 4> corner{};
  for (size_t i = 0; i < 4; ++i) {
    corner[i] = points_[v[i]];
    for (size_t k = 0; k < i; ++k)
      if (corner[k] == corner[i]) return false;
  }
  const auto corner_of = [&](uint32_t point) {
    return static_cast<int>(std::find(corner.begin(), corner.end(), point) - corner.begin());
  };
  std::array<int, 9> to{};
  for (size_t i = 0; i < 9; ++i) {
    if (v[i] == none) {
      to[i] = -1;
      continue;
    }
    const uint32_t point = points_[v[i]];
    to[i] = corner_of(point);
    if (to[i] == 4) {
      if (fixed_[point]) return false;
      to[i] = corner_of(parents_[point]);
      if (to[i] == 4) return false;
    }
  }
  // The node's quads as triangles of corners, by how often each is there.
  const bool wide = v[4] != none, high = v[5] != none;
  const int bottom = wide ? to[4] : 1, top = wide ? to[8] : 3;
  const int left = high ? to[5] : 2, right = high ? to[7] : 3;
  const int centre = wide && high ? to[6] : (wide ? top : right);
  std::array<int, 4> count{};  // of the triangle without corner i, by its sense
  const auto add = [&](int p, int q, int s) {
    if (p == q || q == s || s == p) return;
    const int absent = 6 - p - q - s;
    const int inversions = (p > q ? 1 : 0) + (q > s ? 1 : 0) + (p > s ? 1 : 0);
    count[static_cast<size_t>(absent)] += inversions % 2 == 0 ? 1 : -1;
  };
  const auto add_quad = [&](int a, int b, int c, int d) {
    add(a, b, c);
    add(d, c, b);
  };
  add_quad(0, bottom, left, centre);
  if (wide) add_quad(bottom, 1, centre, right);
  if (high) add_quad(left, centre, 2, top);
  if (wide && high) add_quad(centre, right, top, 3);
  // (a b c) is even and lacks d; (d c b) is odd and lacks a.
  return count == std::array<int, 4>{-1, 0, 0, 1};
}

// What does not collapse into a corner of every node that it lies between the corners of stays. So do the
// corners of what cannot be one quad, which may keep others from being one.
void Maker::settle() {
  for (const Node& node : nodes_) {
    const std::array<uint32_t, 9> v = vertices(node);
    for (size_t i = 4; i < 9; ++i) {
      if (v[i] == none || fixed_[points_[v[i]]]) continue;
      const uint32_t parent = parents_[points_[v[i]]];
      bool corner = false;
      for (size_t k = 0; k < 4; ++k) corner = corner || points_[v[k]] == parent;
      if (!corner) fix(v[i]);
    }
  }
  bool changed = true;
  while (changed) {
    changed = false;
    for (Node& node : nodes_) {
      if (!node.able) continue;
      node.able = is_able(node);
      if (node.able) continue;
      changed = true;
      const std::array<uint32_t, 9> v = vertices(node);
      for (size_t i = 0; i < 4; ++i) fix(v[i]);
    }
  }
}

// Orders the nodes so that each comes behind its children and behind all that have a corner between its own
// corners. False: some wait for each other; the smallest of these are none now.
bool Maker::find_steps() {
  // Of each point the nodes between whose corners it lies.
  std::vector<uint32_t> first(points_.size() + 1, 0), around;
  const auto for_inner = [&](const std::function<void(uint32_t, uint32_t)>& visit) {
    for (uint32_t n = 0; n < nodes_.size(); ++n) {
      if (!nodes_[n].able) continue;
      const std::array<uint32_t, 9> v = vertices(nodes_[n]);
      for (size_t i = 4; i < 9; ++i)
        if (v[i] != none) visit(points_[v[i]], n);
    }
  };
  for_inner([&](uint32_t point, uint32_t) { ++first[point + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  around.resize(first.back());
  std::vector<uint32_t> next(first.begin(), first.end() - 1);
  for_inner([&](uint32_t point, uint32_t node) { around[next[point]++] = node; });

  // What waits for a node: its parent, and those that a corner of it lies in.
  std::vector<uint32_t> waits_for(nodes_.size(), 0);
  const auto for_waiting = [&](uint32_t n, const std::function<void(uint32_t)>& visit) {
    if (nodes_[n].parent != none && nodes_[nodes_[n].parent].able) visit(nodes_[n].parent);
    const std::array<uint32_t, 9> v = vertices(nodes_[n]);
    for (size_t i = 0; i < 4; ++i) {
      const uint32_t point = points_[v[i]];
      for (uint32_t k = first[point]; k < first[point + 1]; ++k) visit(around[k]);
    }
  };
  for (uint32_t n = 0; n < nodes_.size(); ++n)
    if (nodes_[n].able) for_waiting(n, [&](uint32_t other) { ++waits_for[other]; });
  std::vector<uint32_t> ready;
  for (uint32_t n = 0; n < nodes_.size(); ++n) {
    nodes_[n].step = 0;
    if (nodes_[n].able && waits_for[n] == 0) ready.push_back(n);
  }
  for (size_t i = 0; i < ready.size(); ++i) {
    const uint32_t step = nodes_[ready[i]].step + 1;
    for_waiting(ready[i], [&](uint32_t other) {
      nodes_[other].step = std::max(nodes_[other].step, step);
      if (--waits_for[other] == 0) ready.push_back(other);
    });
  }
  uint32_t lowest = none;
  for (uint32_t n = 0; n < nodes_.size(); ++n)
    if (nodes_[n].able && waits_for[n] != 0) lowest = std::min(lowest, nodes_[n].level);
  for (uint32_t n = 0; n < nodes_.size(); ++n) {
    if (!nodes_[n].able || waits_for[n] == 0 || nodes_[n].level != lowest) continue;
    nodes_[n].able = false;
    const std::array<uint32_t, 9> v = vertices(nodes_[n]);
    for (size_t i = 0; i < 4; ++i) fix(v[i]);
  }
  return lowest == none;
}

CollapseMap Maker::write() const {
  CollapseMap map;
  map.points = points_;
  map.parents.resize(points_.size());
  std::iota(map.parents.begin(), map.parents.end(), 0u);
  std::vector<std::vector<uint32_t>> levels, steps;  // of nodes_, and then of map.nodes
  for (uint32_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    const std::array<uint32_t, 9> v = vertices(node);
    bool listed = node.able;
    for (size_t i = 4; i < 9; ++i) {
      if (v[i] == none || fixed_[points_[v[i]]]) continue;
      listed = true;
      for (size_t k = 0; k < 4; ++k)
        if (points_[v[k]] == parents_[points_[v[i]]]) map.parents[v[i]] = v[k];
    }
    if (!listed) continue;
    if (node.level > levels.size()) levels.resize(node.level);
    levels[node.level - 1].push_back(n);
  }
  uint32_t last_step = 0;
  for (const Node& node : nodes_)
    if (node.able) last_step = std::max(last_step, node.step);
  steps.resize(last_step + 2);  // those that cannot be one quad come last
  for (const std::vector<uint32_t>& level : levels) {
    for (uint32_t n : level) {
      const Node& node = nodes_[n];
      steps[node.able ? node.step : last_step + 1].push_back(static_cast<uint32_t>(map.nodes.size()));
      map.nodes.push_back(described(node));
    }
    map.levels.push_back(static_cast<uint32_t>(map.nodes.size()));
  }
  for (const std::vector<uint32_t>& step : steps) {
    map.order.insert(map.order.end(), step.begin(), step.end());
    map.steps.push_back(static_cast<uint32_t>(map.order.size()));
  }
  return map;
}

CoarseNode Maker::described(const Node& node) const {
  const ChartRecord& chart = atlas_.charts[node.chart];
  const auto behind =
      std::upper_bound(atlas_.objects.begin(), atlas_.objects.end(), chart.first_texel,
                       [](uint32_t texel, const AtlasObject& object) { return texel < object.first_texel; });
  const auto object = static_cast<uint32_t>(behind - atlas_.objects.begin() - 1);
  const std::array<uint32_t, 9> v = vertices(node);
  const uint32_t slot =
      chart.first_slot - atlas_.objects[object].first_slot + QuadOrder(chart).slot(node.x, node.y);
  return {object,      node.level,  slot >> (2 * node.level),       v[0],
          v[1] - v[0], v[2] - v[0], v[4] == none ? 0 : v[4] - v[0], v[5] == none ? 0 : v[5] - v[0],
          node.able};
}

}  // namespace

CollapseMap make_collapse_map(const scene::Assembly& assembly, const Atlas& atlas,
                              const std::vector<bool>& kept) {
  return Maker(assembly, atlas, kept).make();
}

}  // namespace lodestone::geometry_image
