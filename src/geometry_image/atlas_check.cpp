// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/atlas_check.h"

#include <atomic>
#include <bit>

#include "lodestone/base/parallel.h"
#include "lodestone/geometry_image/charts.h"
#include "lodestone/geometry_image/quad_order.h"
#include "lodestone/geometry_image/slots.h"

namespace lodestone::geometry_image {
namespace {

const char* chart_fault(const Atlas& atlas, const AtlasObject& object, const layout::ChartRecord& chart,
                        uint64_t first_texel) {
  if (chart.kind > layout::chart_mapped) return "a chart of an unknown kind";
  if (chart.width < 2 || chart.height < 2) return "a chart without a quad";
  if (chart.kind == layout::chart_exact && (chart.width != 3 || chart.height != 3))
    return "an exact chart not of 3 x 3";
  if (chart.kind == layout::chart_mapped && chart.first_triangle != 0)
    return "a mapped chart with a triangle of its own";
  const uint64_t end_texel = uint64_t(object.first_texel) + object.texels;
  if (chart.first_texel != first_texel || texel_count(chart) > end_texel - first_texel) {
    return "charts that do not follow one another";
  }
  // A chart has fewer than 2^31 texels from here on, so nothing below overflows.
  if (chart.first_triangle + triangle_count(chart) > atlas.report.triangles)
    return "a chart of triangles that do not exist";
  const uint64_t own = QuadOrder::block_slots(chart), block = chart.slot_count;
  if (chart.first_slot < object.first_slot || !std::has_single_bit(block) || block < own ||
      (chart.first_slot - object.first_slot) % block != 0)
    return "a chart whose block is not its own";
  if (chart.first_slot + block > uint64_t(object.first_slot) + object.slots)
    return "a chart outside the hierarchy";
  return nullptr;
}

// The charts of an object from `next` on, which becomes the first of the one behind it.
const char* object_fault(const Atlas& atlas, const AtlasObject& object, size_t& next) {
  uint64_t texels = object.first_texel, slots = 0;
  const uint64_t end_texel = texels + object.texels;
  for (; next < atlas.charts.size() && texels < end_texel; ++next) {
    const layout::ChartRecord& chart = atlas.charts[next];
    if (const char* fault = chart_fault(atlas, object, chart, texels)) return fault;
    texels += texel_count(chart);
    slots += chart.slot_count;
  }
  if (texels != end_texel) return "texels of no chart";
  if (slots != object.slots) return "leaves of no chart";
  if (object.depth != tree_depth(object.slots)) return "a hierarchy of the wrong depth";
  return nullptr;
}

const char* objects_fault(const Atlas& atlas) {
  uint64_t texels = 0, slots = 0;
  size_t next = 0;
  for (const AtlasObject& object : atlas.objects) {
    if (object.first_texel != texels || object.first_slot != slots || object.texels == 0)
      return "objects that do not follow one another";
    texels += object.texels;
    slots += object.slots;
    if (texels > atlas.texel_map.size() || slots > atlas.leaf_map.size()) return "objects beyond its end";
    if (const char* fault = object_fault(atlas, object, next)) return fault;
  }
  if (next != atlas.charts.size() || texels != atlas.texel_map.size()) return "texels of no object";
  if (slots != atlas.leaf_map.size()) return "leaves of no object";
  return nullptr;
}

bool is_good_texel(const glm::uvec4& texel, const Atlas& atlas, uint32_t index) {
  const layout::ChartRecord& chart = atlas.charts[index];
  const bool mapped = chart.kind == layout::chart_mapped;
  if (texel == glm::uvec4(0)) return !mapped;
  const uint64_t triangles = mapped ? atlas.report.triangles : triangle_count(chart);
  const float b1 = std::bit_cast<float>(texel.y), b2 = std::bit_cast<float>(texel.z);
  return texel.x >= chart.first_triangle && texel.x - chart.first_triangle < triangles && b1 >= 0 &&
         b2 >= 0 && b1 + b2 <= 1 && texel.w == index + 1;
}

// Whether the quad's four corners are texels.
bool is_whole(const Atlas& atlas, const layout::ChartRecord& chart, const QuadOrder::Quad& quad) {
  if (!quad.exists) return false;
  const glm::uvec4* a = &atlas.texel_map[chart.first_texel + size_t(quad.y) * chart.width + quad.x];
  return a[0].w != 0 && a[1].w != 0 && a[chart.width].w != 0 && a[chart.width + 1].w != 0;
}

struct ChartFindings {
  bool texels_good = true, leaves_good = true;
  uint64_t quads = 0;
};

ChartFindings inspect(const Atlas& atlas, uint32_t index) {
  const layout::ChartRecord& chart = atlas.charts[index];
  ChartFindings found;
  for (uint64_t i = 0; i < texel_count(chart); ++i) {
    found.texels_good =
        found.texels_good && is_good_texel(atlas.texel_map[chart.first_texel + i], atlas, index);
  }
  const QuadOrder order(chart);
  for (uint32_t slot = 0; slot < chart.slot_count; ++slot) {
    const QuadOrder::Quad quad = order.quad(slot);
    glm::uvec2 expected{layout::empty_slot, 0};
    if (is_whole(atlas, chart, quad)) {
      expected = {chart.first_texel + quad.y * chart.width + quad.x, chart.width};
      ++found.quads;
    }
    found.leaves_good = found.leaves_good && atlas.leaf_map[size_t(chart.first_slot) + slot] == expected;
  }
  // Every chart has a quad in its block, so two blocks that overlapped would contradict each other.
  found.leaves_good = found.leaves_good && found.quads > 0;
  return found;
}

const char* maps_fault(const Atlas& atlas) {
  constexpr uint64_t charts_a_task = 1u << 10;
  std::atomic<bool> texels_good = true, leaves_good = true;
  std::atomic<uint64_t> quads = 0;
  parallel_for(atlas.charts.size(), charts_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const ChartFindings found = inspect(atlas, static_cast<uint32_t>(i));
      if (!found.texels_good) texels_good = false;
      if (!found.leaves_good) leaves_good = false;
      quads += found.quads;
    }
  });
  if (!texels_good) return "a texel that samples nothing of its chart";
  if (!leaves_good) return "a leaf that is not the quad it should be";
  if (quads != atlas.report.quads) return "another number of quads than it says";
  return nullptr;
}

}  // namespace

std::string find_fault(const Atlas& atlas) {
  if (atlas.charts.empty()) return "no chart";
  if (atlas.report.texels != atlas.texel_map.size() || atlas.report.slots != atlas.leaf_map.size()) {
    return "a report of another atlas";
  }
  if (const char* fault = objects_fault(atlas)) return fault;
  if (const char* fault = maps_fault(atlas)) return fault;
  std::string fault = find_fault(atlas.maps, atlas.charts, atlas.texel_map, atlas.report.triangles);
  if (!fault.empty()) return fault;
  if (atlas.kind != kind_of(atlas.charts)) return "charts of another kind than it says";
  return {};
}

}  // namespace lodestone::geometry_image
