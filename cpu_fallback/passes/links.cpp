// SPDX-License-Identifier: MIT
#include "lodestone/layout/links.h"
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/atlas.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/links.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Links : public VaryingKernel<Probe> {
 public:
  using VaryingKernel<Probe>::VaryingKernel;

  HWY_ATTR void operator()() {
    const uvec1 index = this->own_index();
    const uvec1 address = level_base(push_.depth) + index;
    uvec1 hit = 4u * address + 1u;
    if (push_.depth == push_.leaf_depth) hit = leaf_flag | this->load(leaf_map_, push_.first_slot + index, 2);
    this->store(links_, push_.first_node + address, hit, 2);
    this->store(links_, push_.first_node + address, miss(index), 2, 1);
  }

 private:
  // The next node that holds a quad and is no descendant; 0: none.
  HWY_ATTR uvec1 miss(uvec1 index) {
    uvec1 link = 0u, depth = push_.depth, next = index + 1u;
    bvec1 searching = this->active();
    while (any_lane(searching)) {
      const uvec1 up = uvec1(findLSB(next)) >> 1u;
      const uvec1 place = next >> (2u * up);
      searching = searching && up < depth;  // not past the root
      const uvec1 level = select(searching, depth - up, 0u);
      // Or nothing but padding from there on.
      searching = searching && (place << (2u * (push_.leaf_depth - level))) < push_.slots;
      const bvec1 leaf = searching && level == push_.leaf_depth;
      bvec1 empty = false;
      if (const Where leaves(*this, leaf); leaves.any()) {
        empty = leaf && this->load(leaf_map_, push_.first_slot + place, 2) == empty_slot;
      }
      link = select(searching && !empty, level_base(level) + place, link);
      searching = empty;
      next = place + 1u;
      depth = level;
    }
    return link;
  }

  Words leaf_map_ = this->words(0), links_ = this->words(1);
  LinksPush push_ = this->template push<LinksPush>();
};

LODESTONE_VARYING_BLOCK_FUNCTION(links, Links)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(links_block);

void links(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 4096, HWY_DYNAMIC_DISPATCH(links_block));
}

}  // namespace lodestone::cpu_fallback
#endif
