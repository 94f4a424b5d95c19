// SPDX-License-Identifier: MIT
#include "lodestone/render/leaf_blocks.h"

#include <gtest/gtest.h>

#include "lodestone/layout/atlas.h"

namespace lodestone::render {
namespace {

// The quads of a chart of width x height quads whose corners a start at `first`, in Morton order, in 16
// slots.
void add_chart(std::vector<glm::uvec2>& slots, uint32_t first, uint32_t stride, uint32_t width,
               uint32_t height) {
  for (uint32_t k = 0; k < 16; ++k) {
    const uint32_t x = layout::gather_bits(k), y = layout::gather_bits(k >> 1);
    const bool there = x < width && y < height;
    slots.emplace_back(there ? first + x + y * stride : layout::empty_slot, there ? stride : 0);
  }
}

TEST(LeafBlocks, AreWholeAndPartialRectanglesOfOneChart) {
  std::vector<glm::uvec2> slots;
  add_chart(slots, 100, 9, 4, 4);
  add_chart(slots, 7, 5, 3, 1);
  add_chart(slots, 0, 0, 0, 0);
  const LeafBlocks found = find_leaf_blocks(slots, HierarchyLevels(3, uint32_t(slots.size())));
  ASSERT_EQ(found.blocks.size(), 4u);  // with the padding of the level above
  EXPECT_EQ(found.blocks[0], glm::uvec4(0, 100, 9, 4 | 4 << 8));
  EXPECT_EQ(found.blocks[1], glm::uvec4(1, 7, 5, 3 | 1 << 8));
  EXPECT_EQ(found.blocks[2], glm::uvec4(2, 0, 0, 0));
  EXPECT_EQ(found.blocks[3], glm::uvec4(3, 0, 0, 0));
  EXPECT_TRUE(found.others.empty());
}

TEST(LeafBlocks, LeaveWhatIsNotOneRectangle) {
  std::vector<glm::uvec2> slots;
  add_chart(slots, 0, 9, 4, 4);
  add_chart(slots, 50, 9, 4, 4);
  add_chart(slots, 90, 9, 4, 4);
  add_chart(slots, 130, 9, 4, 4);
  slots[3] = {layout::empty_slot, 0};  // a hole
  slots[16 + 12] = {7, 9};             // a quad from elsewhere
  slots[32 + 5].y = 8;                 // of another stride
  const LeafBlocks found = find_leaf_blocks(slots, HierarchyLevels(3, uint32_t(slots.size())));
  EXPECT_EQ(found.others, (std::vector<uint32_t>{0, 1, 2}));
  ASSERT_EQ(found.blocks.size(), 1u);
  EXPECT_EQ(found.blocks[0].x, 3u);
}

TEST(LeafBlocks, AreToldOfEverySixteenSlots) {
  std::vector<glm::uvec2> slots;
  add_chart(slots, 100, 9, 4, 4);
  add_chart(slots, 50, 9, 4, 4);
  slots[16 + 12] = {7, 9};  // a quad from elsewhere
  add_chart(slots, 0, 0, 0, 0);
  add_chart(slots, 7, 5, 2, 2);
  slots.resize(3 * 16 + 4);
  const std::vector<glm::uvec4> groups = sixteen_slots(slots);
  ASSERT_EQ(groups.size(), 4u);
  EXPECT_EQ(groups[0], glm::uvec4(1, 100, 9, 4 | 4 << 8));
  EXPECT_EQ(groups[1], glm::uvec4(0));
  EXPECT_EQ(groups[2], glm::uvec4(1, 0, 0, 0));
  EXPECT_EQ(groups[3], glm::uvec4(1, 7, 5, 2 | 2 << 8));
}

}  // namespace
}  // namespace lodestone::render
