// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/boxes.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class BoxesBlocks : public BoxesKernel<Probe> {
 public:
  using BoxesKernel<Probe>::BoxesKernel;

  void operator()(uint32_t index) {
    if (index >= this->push_.count) return;
    const glm::uvec4 block = this->load(blocks_, this->push_.first_item + index);
    const uint32_t stride = block.z, width = block.w & 255, height = block.w >> 8;
    glm::vec3 points[5][5];
    for (uint32_t y = 0; y < 5; ++y) {
      for (uint32_t x = 0; x < 5; ++x) {
        const uint32_t texel = block.y + std::min(y, height) * stride + std::min(x, width);
        points[y][x] = as_vec3(this->load(geometry_, texel));
      }
    }
    layout::Box parents[4];
    for (uint32_t parent = 0; parent < 4; ++parent) {
      layout::Box children[4];
      for (uint32_t child = 0; child < 4; ++child) {
        const uint32_t x = 2 * (parent & 1) + (child & 1), y = 2 * (parent >> 1) + (child >> 1);
        children[child] = layout::empty_box();
        if (x >= width || y >= height) continue;
        const layout::Bound bound =
            layout::quad_bound(points[y][x], points[y][x + 1], points[y + 1][x], points[y + 1][x + 1]);
        children[child] = layout::bound_box(bound.lo, bound.hi, this->push_.grid, per_step_);
      }
      parents[parent] = this->store_record(boxes_, this->push_.depth - 1, 4 * block.x + parent, children);
    }
    this->store_record(boxes_, this->push_.depth - 2, block.x, parents);
  }

 private:
  Quads blocks_ = this->quads(0), geometry_ = this->quads(1), boxes_ = this->quads(2);
  glm::vec3 per_step_ = glm::vec3(1, 1, 1) / this->push_.grid.step;
};

LODESTONE_BLOCK_FUNCTION(static, boxes_blocks, BoxesBlocks)

}  // namespace

void boxes_blocks(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, boxes_blocks_block);
}

}  // namespace lodestone::cpu_fallback
