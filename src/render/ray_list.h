// SPDX-License-Identifier: MIT
// The rays that have something to do, found and put side by side (shaders/layout/ray_list.h).
#pragma once

#include "lodestone/render/tracing.h"

namespace lodestone::render {

struct RayListing {
  const PassDecl &list, &scan;  // by the name of what they are done for
  const RayBuffers& rays;
  uint32_t count;                            // of rays: those of `some`, or where that is null the first
  const Buffer* some;                        // a list
  const Buffer& to;                          // where the list goes; not `some`
  uint32_t resume = layout::resume_nothing;  // layout::TracePush::resume: what makes a ray one of the list
  bool resumable = false;                    // states are kept
  const Buffer* shadow_rays =
      nullptr;  // of rays that are not listed for they have ended; null: they have not

  // How many there are: word 0 of `to`, once the device has come so far.
  void find(Backend& backend) const;
  uint32_t found(Backend& backend) const;  // waits
  // Their numbers, behind that word. After find().
  void place(Backend& backend) const;

 private:
  void run_stage(Backend& backend, uint32_t stage) const;
};

}  // namespace lodestone::render
