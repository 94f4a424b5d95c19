// SPDX-License-Identifier: MIT
#include "lodestone/render/detail.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/layout/detail_nodes.h"
#include "lodestone/render/hierarchy_levels.h"
#include "lodestone/render/passes.h"
#include "lodestone/render/scene_tables.h"

namespace lodestone::render {
namespace {

// Scattered rays tolerate up to an error of a 64th of the way they have gone. The larger this is, the smaller
// quads must be (layout::corner_radius).
constexpr float steepest_scattered = 1.0f / 64;

}  // namespace

layout::RayCone camera_cone(const View& view, uint32_t width, uint32_t height, float pixels_of_error) {
  const float across = glm::length(view.right) * 2 / static_cast<float>(width),
              up = glm::length(view.up) * 2 / static_cast<float>(height);
  const float pixel = std::min(across, up) * pixels_of_error;
  layout::RayCone cone{view.origin, 0, 0};
  if (view.perspective) {
    // Pixels in the corners are the farthest away: there an error looks smallest.
    cone.spread = pixel / glm::length(view.forward + view.right + view.up);
  } else {
    cone.width = pixel;
  }
  return cone;
}

float steepest_cone(const layout::RayCone& camera) {
  return std::max(camera.spread * 1.001f, steepest_scattered);
}

Detail::Detail(Backend& backend, const scene::Assembly& assembly, const geometry_image::Atlas& atlas,
               const std::vector<uint32_t>& first_emitters)
    : backend_(backend), texels_(static_cast<uint32_t>(atlas.texel_map.size())) {
  if (atlas.texel_map.size() > layout::most_detailed_texels) {
    fail(ExitCode::usage, "--pixels-of-error",
         "takes at most {} texels, and the scene has {}; draw it without", layout::most_detailed_texels,
         atlas.texel_map.size());
  }
  std::vector<bool> kept;
  for (const uint32_t emitter : first_emitters) kept.push_back(emitter != 0);
  const geometry_image::CollapseMap map = geometry_image::make_collapse_map(assembly, atlas, kept);
  levels_ = map.levels;
  steps_ = map.steps;
  points_ = make_buffer(backend, "points", 4, map.points);
  coarse_order_ = make_buffer(backend, "coarse_order", 4, map.order);
  std::vector<uint32_t> collapses(2 * size_t(texels_));
  for (size_t i = 0; i < texels_; ++i) collapses[2 * i] = map.parents[i];
  collapses_ = make_buffer(backend, "collapses", 4, collapses);
  radii_ = Buffer(backend, {"radii", texels_, 4});
  upload_nodes(atlas, map);
}

void Detail::upload_nodes(const geometry_image::Atlas& atlas, const geometry_image::CollapseMap& map) {
  uint64_t count = 0;  // of nodes above the leaves
  for (const geometry_image::AtlasObject& object : atlas.objects) {
    first_nodes_.push_back(static_cast<uint32_t>(count));
    const HierarchyLevels levels(object.depth, object.slots);
    count += uint64_t(layout::level_base(object.depth - 1)) + levels.places(object.depth - 1);
  }
  std::vector<layout::CoarseNode> nodes;
  std::vector<glm::uvec4> quads(count, glm::uvec4(layout::no_index, 0, 0, 0));
  for (const geometry_image::CoarseNode& node : map.nodes) {
    const uint32_t depth = atlas.objects[node.object].depth - node.level;
    const uint32_t first = first_nodes_[node.object], number = first + layout::level_base(depth) + node.index;
    nodes.push_back(
        {number, node.level > 1 ? first + layout::level_base(depth + 1) + 4 * node.index : layout::no_index,
         node.texel, node.whole ? layout::coarse_whole : 0, node.across, node.along, node.half_across,
         node.half_along});
    if (node.whole) quads[number] = {node.texel, node.across, node.along, node.level};
  }
  coarse_nodes_ = Buffer(backend_, {"coarse_nodes", 2 * nodes.size(), 16});
  if (!nodes.empty()) backend_.upload(coarse_nodes_.id(), std::as_bytes(std::span(nodes)));
  coarse_quads_ = make_buffer(backend_, "coarse_quads", 16, quads);
  const auto never = std::bit_cast<uint32_t>(layout::fixed_radius);
  std::vector<glm::uvec4> details;
  for (uint64_t i = 0; i < count; ++i) {
    details.emplace_back(0);
    details.emplace_back(never, never, 0, 0);
  }
  node_details_ = make_buffer(backend_, "node_details", 16, details);
}

void Detail::run_on_texels(const PassDecl& pass, const std::vector<BufferId>& buffers) {
  const layout::CountPush push{texels_};
  backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), texels_, {}});
}

void Detail::run_on_nodes(const PassDecl& pass, const std::vector<BufferId>& buffers,
                          const std::vector<uint32_t>& ends, float steepest) {
  uint32_t first = 0;
  for (uint32_t end : ends) {
    const layout::DetailPush push{first, end - first, steepest};
    if (push.count > 0) backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), push.count, {}});
    first = end;
  }
}

void Detail::build(const Buffer& geometry, float steepest) {
  run_on_texels(passes::detail_begin, {collapses_.id(), radii_.id()});
  const std::vector<BufferId> buffers = {coarse_nodes_.id(), geometry.id(),      collapses_.id(),
                                         points_.id(),       node_details_.id(), radii_.id()};
  run_on_nodes(passes::detail_measure, buffers, levels_, steepest);
  std::vector<BufferId> ordered = buffers;
  ordered.push_back(coarse_order_.id());
  run_on_nodes(passes::detail_settle, ordered, steps_, steepest);
  run_on_texels(passes::detail_end, {collapses_.id(), points_.id(), radii_.id()});
}

}  // namespace lodestone::render
