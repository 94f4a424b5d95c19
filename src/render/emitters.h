// SPDX-License-Identifier: MIT
// Surfaces that shine, on the device: the tables that points of them are drawn by, and these points
// (layout/emitters.h).
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/render/backend.h"
#include "lodestone/render/emitter_data.h"

namespace lodestone::render {

class Emitters {
 public:
  // For `rays` rays.
  Emitters(Backend& backend, const EmitterData& data, uint64_t rays);

  // Where each emitter is, if that is another geometry image than the atlas's.
  void place(const std::vector<uint32_t>& texels);

  // Of each object in its own space, in the rest pose.
  const std::vector<double>& powers() const { return powers_; }

  const Buffer& numbers() const { return numbers_; }
  const Buffer& texels() const { return texels_; }
  const Buffer& objects() const { return objects_; }
  const Buffer& drawn() const { return drawn_; }  // layout::DrawnPoint, one a ray
  uint32_t half_step() const { return half_step_; }

 private:
  Backend& backend_;
  std::vector<double> powers_;
  uint32_t half_step_ = 0;  // layout::EmitterPush
  Buffer numbers_, texels_, objects_, drawn_;
};

}  // namespace lodestone::render
