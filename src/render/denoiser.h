// SPDX-License-Identifier: MIT
// An edge-avoiding filter over a picture's light, after all samples (layout/denoise_filter.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/render/backend.h"
#include "lodestone/render/renderer.h"

namespace lodestone::render {

// What it does to a picture, in one line for reports.
std::string denoise_description();

class Denoiser {
 public:
  // Throws Error(usage) for less than two samples: the filter tells noise from detail by how they differ.
  Denoiser(Backend& backend, const Settings& settings, uint32_t batch_rays);

  // Of a batch's samples, in their order: what the camera's rays have hit, before they go on, and what has
  // become of the pixels. `surface`: the buffers of `surface.h`, then the rays.
  void add_features(std::vector<BufferId> surface, const std::array<uint32_t, pass_constants>& constants,
                    uint32_t rays, bool first);
  void add_sample(const Buffer& radiance, uint32_t rays, bool first);
  // After the last one, when `resolve` has run.
  void end_batch(const Buffer& frame, const Buffer& radiance, uint32_t first_ray, uint32_t rays);

  // After the last batch; `noisy` and `display` are what `resolve` wrote, and `display` is written again.
  void filter(const Buffer& frame, const Buffer& noisy, const Buffer& display);

  const Buffer& beauty() const { return beauty_; }

 private:
  template <class Push>
  void run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push, uint32_t invocations,
           const std::array<uint32_t, pass_constants>& constants = {});

  Backend& backend_;
  const uint32_t width_, height_;
  const bool tinted_;
  Buffer features_, moments_;  // of a batch
  Buffer guides_, light_, filtered_, beauty_;
};

}  // namespace lodestone::render
