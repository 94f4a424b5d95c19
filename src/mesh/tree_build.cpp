// SPDX-License-Identifier: MIT
#include "lodestone/mesh/tree_build.h"

#include <algorithm>
#include <tuple>

#include "lodestone/base/parallel.h"

namespace lodestone::mesh {
namespace {

constexpr uint32_t leaf_size = std::tuple_size_v<TreeLeaf>;

// Deeper nodes are halved, which ends after 30 more levels whatever the triangles are.
constexpr uint32_t max_uneven_depth = 40;

// Runs of fewer triangles are built on one thread.
constexpr uint32_t parallel_run = 1u << 14;

struct Item {
  Box box;
  uint32_t triangle = none;

  // Halved before they are added: the sum of two floats may be infinite.
  float center(int axis) const { return 0.5f * box.lo[axis] + 0.5f * box.hi[axis]; }
};

uint32_t leaves_of(uint64_t triangles) {
  return static_cast<uint32_t>((triangles + leaf_size - 1) / leaf_size);
}

double half_area(const Box& box) {
  const glm::dvec3 size = glm::dvec3(box.hi) - glm::dvec3(box.lo);
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

struct Bin {
  Box box;
  uint64_t count = 0;

  void add(const Bin& bin) {
    box.add(bin.box);
    count += bin.count;
  }
  double cost() const { return count == 0 ? 0.0 : half_area(box) * leaves_of(count); }
};

// How many of the items, in the order of their centers along `axis`, go to the first child: whole leaves, at
// least one, and not all. By the surface area heuristic over bins.
uint64_t cheapest_split(const Item* items, uint64_t count, const Box& centers, int axis) {
  constexpr int bin_count = 16;
  std::array<Bin, bin_count> bins;
  const double start = centers.lo[axis], scale = bin_count / (centers.hi[axis] - start);
  for (uint64_t i = 0; i < count; ++i) {
    Bin& bin = bins[std::min(static_cast<int>((items[i].center(axis) - start) * scale), bin_count - 1)];
    bin.box.add(items[i].box);
    ++bin.count;
  }
  std::array<double, bin_count> cost_behind;
  Bin behind;
  for (int i = bin_count - 1; i > 0; --i) {
    behind.add(bins[i]);
    cost_behind[i] = behind.cost();
  }
  Bin before;
  uint64_t best_count = count / 2;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int i = 1; i < bin_count; ++i) {
    before.add(bins[i - 1]);
    const double cost = before.cost() + cost_behind[i];
    if (before.count != 0 && before.count != count && cost < best_cost) {
      best_cost = cost;
      best_count = before.count;
    }
  }
  const uint64_t whole_leaves = (best_count + leaf_size / 2) / leaf_size;
  return std::clamp<uint64_t>(whole_leaves, 1, leaves_of(count) - 1) * leaf_size;
}

// Sorts the items into the order of leaves and fills the nodes, in preorder. As every leaf but the last is
// full, a run of items tells how many nodes it takes, so that runs can be built side by side.
class Builder {
 public:
  Builder(std::vector<Item>& items, std::vector<TreeNode>& nodes) : items_(items), nodes_(nodes) {}

  // The run starts at a leaf and has at least one item; its nodes are those from `node` on.
  TreeChild build(uint64_t first, uint64_t count, uint32_t node, uint32_t depth) {
    if (count <= leaf_size) {
      TreeChild leaf;
      for (uint64_t i = first; i < first + count; ++i) leaf.box.add(items_[i].box);
      leaf.reference = TreeChild::leaf_bit + static_cast<uint32_t>(first / leaf_size);
      return leaf;
    }
    const uint64_t left = split(first, count, depth);
    std::array<TreeChild, 2>& children = nodes_[node].children;
    const auto build_child = [&](uint64_t child) {
      children[child] = child == 0 ? build(first, left, node + 1, depth + 1)
                                   : build(first + left, count - left, node + leaves_of(left), depth + 1);
    };
    if (count < parallel_run) {
      build_child(0);
      build_child(1);
    } else {
      parallel_for(2, 1, [&](uint64_t child, uint64_t) { build_child(child); });
    }
    TreeChild inner{children[0].box, node};
    inner.box.add(children[1].box);
    return inner;
  }

 private:
  // The number of items of the first child, which come first from now on.
  uint64_t split(uint64_t first, uint64_t count, uint32_t depth) {
    Item* items = items_.data() + first;
    Box centers;
    for (uint64_t i = 0; i < count; ++i)
      centers.add(glm::vec3(items[i].center(0), items[i].center(1), items[i].center(2)));
    const glm::dvec3 size = glm::dvec3(centers.hi) - glm::dvec3(centers.lo);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint64_t left = size[axis] > 0 && depth < max_uneven_depth
                              ? cheapest_split(items, count, centers, axis)
                              : leaves_of(count) / 2 * uint64_t(leaf_size);
    std::nth_element(items, items + left, items + count,
                     [axis](const Item& a, const Item& b) { return a.center(axis) < b.center(axis); });
    return left;
  }

  std::vector<Item>& items_;
  std::vector<TreeNode>& nodes_;
};

std::vector<Item> make_items(const Surface& surface) {
  std::vector<Item> items(surface.triangles.size());
  parallel_for(items.size(), parallel_run, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      items[i].triangle = static_cast<uint32_t>(i);
      for (int corner = 0; corner < 3; ++corner)
        items[i].box.add(surface.positions[surface.triangles[i][corner]]);
    }
  });
  return items;
}

std::vector<TreeLeaf> make_leaves(const Surface& surface, const std::vector<Item>& items) {
  std::vector<TreeLeaf> leaves(leaves_of(items.size()));
  parallel_for(leaves.size(), parallel_run / leaf_size, [&](uint64_t begin, uint64_t end) {
    for (uint64_t leaf = begin; leaf < end; ++leaf) {
      for (uint32_t place = 0; place < leaf_size; ++place) {
        const uint64_t item = std::min<uint64_t>(leaf * leaf_size + place, items.size() - 1);
        TreeTriangle& triangle = leaves[leaf][place];
        triangle.triangle = items[item].triangle;
        for (int corner = 0; corner < 3; ++corner)
          triangle.corners[corner] = surface.positions[surface.triangles[triangle.triangle][corner]];
      }
    }
  });
  return leaves;
}

}  // namespace

Tree build_tree(const Surface& surface) {
  check(surface);
  Tree tree;
  std::vector<Item> items = make_items(surface);
  if (items.empty()) return tree;
  tree.nodes.resize(leaves_of(items.size()) - 1);
  tree.root = Builder(items, tree.nodes).build(0, items.size(), 0, 0);
  tree.leaves = make_leaves(surface, items);
  return tree;
}

}  // namespace lodestone::mesh
