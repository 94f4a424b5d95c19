// SPDX-License-Identifier: MIT
#include "lodestone/render/denoiser.h"

#include <fmt/format.h>

#include <utility>

#include "lodestone/base/error.h"
#include "lodestone/layout/denoise.h"
#include "lodestone/layout/frame.h"
#include "lodestone/render/passes.h"

namespace lodestone::render {
namespace {

uint64_t pixels_of(const Settings& settings) {
  return uint64_t(settings.width) * settings.height;
}

}  // namespace

std::string denoise_description() {
  return fmt::format(
      "edge-avoiding a-trous wavelet, {} levels, by albedo, normal, position and the variance of the "
      "samples; "
      "blurs what the samples did not resolve",
      layout::denoise_levels);
}

Denoiser::Denoiser(Backend& backend, const Settings& settings, uint32_t batch_rays)
    : backend_(backend),
      width_(settings.width),
      height_(settings.height),
      tinted_(settings.integrator != Integrator::ao) {
  if (settings.spp < 2)
    fail(ExitCode::usage, "--denoise",
         "tells noise from detail by how a pixel's samples differ, and there is one; give --spp 2 or more");
  features_ = Buffer(backend, {"features", 3 * uint64_t(batch_rays), 16});
  moments_ = Buffer(backend, {"moments", 2 * uint64_t(batch_rays), 16});
  guides_ = Buffer(backend, {"guides", 3 * pixels_of(settings), 16});
  light_ = Buffer(backend, {"light", pixels_of(settings), 16});
  filtered_ = Buffer(backend, {"filtered", pixels_of(settings), 16});
  beauty_ = Buffer(backend, {"denoised", pixels_of(settings), 16});
}

template <class Push>
void Denoiser::run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push,
                   uint32_t invocations, const std::array<uint32_t, pass_constants>& constants) {
  backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), invocations, constants});
}

void Denoiser::add_features(std::vector<BufferId> surface,
                            const std::array<uint32_t, pass_constants>& constants, uint32_t rays,
                            bool first) {
  surface.push_back(features_.id());
  run(passes::features, surface, layout::FeaturesPush{rays, first ? 1u : 0u, tinted_ ? 1u : 0u}, rays,
      constants);
}

void Denoiser::add_sample(const Buffer& radiance, uint32_t rays, bool first) {
  run(passes::denoise_moments, {radiance.id(), moments_.id()}, layout::MomentsPush{rays, first ? 1u : 0u},
      rays);
}

void Denoiser::end_batch(const Buffer& frame, const Buffer& radiance, uint32_t first_ray, uint32_t rays) {
  run(passes::denoise_begin,
      {frame.id(), radiance.id(), features_.id(), moments_.id(), guides_.id(), light_.id()},
      layout::ResolvePush{first_ray, rays}, rays);
}

void Denoiser::filter(const Buffer& frame, const Buffer& noisy, const Buffer& display) {
  const uint32_t pixels = width_ * height_;
  layout::DenoisePush push{width_, height_, 1};
  const auto apply = [&](const PassDecl& pass) {
    run(pass, {guides_.id(), light_.id(), filtered_.id()}, push, pixels);
    std::swap(light_, filtered_);
  };
  apply(passes::denoise_variance);
  for (uint32_t level = 0; level < layout::denoise_levels; ++level) {
    push.step = 1u << level;
    apply(passes::denoise_filter);
  }
  run(passes::denoise_end, {frame.id(), guides_.id(), light_.id(), noisy.id(), beauty_.id(), display.id()},
      layout::CountPush{pixels}, pixels);
}

}  // namespace lodestone::render
