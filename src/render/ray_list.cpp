// SPDX-License-Identifier: MIT
#include "lodestone/render/ray_list.h"

#include "lodestone/layout/frame.h"

namespace lodestone::render {

void RayListing::run_stage(Backend& backend, uint32_t stage) const {
  const layout::ListPush push{count, layout::list_block(count)};
  // What the constants leave out nothing reads or writes; any words and quads will do.
  const std::array<BufferId, 8> buffers{rays.rays.id(),
                                        rays.hits.id(),
                                        rays.states.id(),
                                        rays.block_counts.id(),
                                        rays.block_starts.id(),
                                        some != nullptr ? some->id() : rays.steps.id(),
                                        to.id(),
                                        shadow_rays != nullptr ? shadow_rays->id() : rays.states.id()};
  backend.run(
      {&list,
       buffers,
       std::as_bytes(std::span(&push, 1)),
       list_blocks(push),
       {stage, resume, resumable ? 1u : 0u, some != nullptr ? 1u : 0u, shadow_rays != nullptr ? 1u : 0u}});
}

void RayListing::find(Backend& backend) const {
  run_stage(backend, layout::list_count);
  const layout::CountPush blocks{list_blocks({count, layout::list_block(count)})};
  const std::array<BufferId, 3> buffers{rays.block_counts.id(), rays.block_starts.id(), to.id()};
  backend.run({&scan, buffers, std::as_bytes(std::span(&blocks, 1)), 1});
}

uint32_t RayListing::found(Backend& backend) const {
  uint32_t number = 0;
  backend.download(to.id(), std::as_writable_bytes(std::span(&number, 1)), 0);
  return number;
}

void RayListing::place(Backend& backend) const {
  run_stage(backend, layout::list_place);
}

}  // namespace lodestone::render
