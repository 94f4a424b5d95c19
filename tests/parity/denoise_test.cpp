// SPDX-License-Identifier: MIT
// What denoising takes away and what it leaves alone: of pictures made up for one question each, on every
// device, and of rendered ones.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "lodestone/base/error.h"
#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/layout/denoise.h"
#include "lodestone/layout/shading.h"
#include "lodestone/render/denoiser.h"
#include "lodestone/render/passes.h"
#include "lodestone/render/scene_tables.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/picture.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

constexpr uint32_t side = 32, samples = 8;

// What a pixel of a made-up picture shows.
struct Pixel {
  glm::vec3 albedo{0.5f};
  glm::vec3 normal{0, 0, 1};
  glm::vec3 position{0};
  glm::vec3 light{1};  // without noise, as the surface gets it
  float noise = 0;     // standard deviation of a sample's, as a share of the light
};

using Scenery = std::function<Pixel(uint32_t x, uint32_t y)>;

// A wall across the view.
Pixel wall(uint32_t x, uint32_t y) {
  Pixel pixel;
  pixel.position = {x, y, -40};
  return pixel;
}

struct Pictures {
  std::vector<glm::vec3> tint, clean, noisy, denoised;
};

// Sums of samples as the passes before leave them, in the order of rays.
struct Sums {
  std::vector<glm::vec4> features = std::vector<glm::vec4>(3 * side * side);
  std::vector<glm::vec4> moments = std::vector<glm::vec4>(2 * side * side);
  std::vector<glm::vec4> radiance = std::vector<glm::vec4>(side * side);
};

Sums sums_of(const Scenery& scenery, Pictures& pictures) {
  Sums sums;
  pictures.clean.resize(side * side);
  pictures.tint.resize(side * side);
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  const auto n = static_cast<float>(samples);
  for (uint32_t ray = 0; ray < side * side; ++ray) {
    uint32_t x = 0, y = 0;
    layout::ray_pixel(ray, side, side, x, y);
    const Pixel pixel = scenery(x, y);
    const glm::vec3 tint = layout::demodulator(pixel.albedo), clean = pixel.light * tint;
    pictures.tint[y * side + x] = tint;
    pictures.clean[y * side + x] = clean;
    sums.features[3 * ray] = glm::vec4(tint * n, n);
    sums.features[3 * ray + 1] = glm::vec4(pixel.normal * n, 0);
    sums.features[3 * ray + 2] = glm::vec4(pixel.position * n, 0);
    for (uint32_t s = 0; s < samples; ++s) {
      const glm::vec3 sample = clean * (1 + pixel.noise * normal(random));
      sums.radiance[ray] += glm::vec4(sample, 1);
      sums.moments[2 * ray] += glm::vec4(sample * sample, 0);
    }
  }
  return sums;
}

class Denoise : public testing::TestWithParam<std::string> {
 protected:
  template <class Push>
  static void run(render::Backend& backend, const render::PassDecl& pass,
                  const std::vector<render::BufferId>& buffers, const Push& push) {
    backend.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), side * side, {}});
  }

  // By the passes of the denoiser, from `begin` on.
  static Pictures denoised(const Scenery& scenery) {
    const auto backend = open(GetParam(), {.validate = GetParam() != "cpu"});
    Pictures pictures;
    const Sums sums = sums_of(scenery, pictures);
    const auto buffer = [&](const char* name, const std::vector<glm::vec4>& items) {
      return render::make_buffer(*backend, name, 16, items);
    };
    const render::Buffer features = buffer("features", sums.features),
                         moments = buffer("moments", sums.moments),
                         radiance = buffer("radiance", sums.radiance);
    layout::FrameRecord record{};
    record.width = record.height = side;
    record.spp = samples;
    const render::Buffer frame =
        render::make_buffer(*backend, "frame", sizeof(record), std::vector<layout::FrameRecord>{record});
    const std::vector<glm::vec4> blank(side * side);
    render::Buffer guides = buffer("guides", std::vector<glm::vec4>(3 * side * side)),
                   light = buffer("light", blank), filtered = buffer("filtered", blank);
    const render::Buffer noisy = buffer("noisy", blank), beauty = buffer("beauty", blank),
                         display = buffer("display", blank);
    const layout::ResolvePush all{0, side * side};
    run(*backend, render::passes::resolve, {frame.id(), radiance.id(), noisy.id(), display.id()}, all);
    run(*backend, render::passes::denoise_begin,
        {frame.id(), radiance.id(), features.id(), moments.id(), guides.id(), light.id()}, all);
    layout::DenoisePush push{side, side, 1};
    run(*backend, render::passes::denoise_variance, {guides.id(), light.id(), filtered.id()}, push);
    for (uint32_t level = 0; level < layout::denoise_levels; ++level) {
      std::swap(light, filtered);
      push.step = 1u << level;
      run(*backend, render::passes::denoise_filter, {guides.id(), light.id(), filtered.id()}, push);
    }
    run(*backend, render::passes::denoise_end,
        {frame.id(), guides.id(), filtered.id(), noisy.id(), beauty.id(), display.id()},
        layout::CountPush{side * side});
    pictures.noisy = colors(*backend, noisy);
    pictures.denoised = colors(*backend, beauty);
    return pictures;
  }

 private:
  static std::vector<glm::vec3> colors(render::Backend& backend, const render::Buffer& buffer) {
    std::vector<glm::vec4> quads(side * side);
    backend.download(buffer.id(), std::as_writable_bytes(std::span(quads)), 0);
    return {quads.begin(), quads.end()};
  }
};

// Root of the mean square difference in green.
double error(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a[i].y) - b[i].y, 2);
  return std::sqrt(sum / double(a.size()));
}

TEST_P(Denoise, LeavesAPictureWithoutNoiseAlone) {
  const Pictures even = denoised(wall);
  const Pictures drawn = denoised([](uint32_t x, uint32_t y) {
    Pixel pixel = wall(x, y);
    pixel.light =
        glm::vec3((x / 3 + y / 5) % 2 == 0 ? 0.25f : 0.75f, 0.5f + 0.01f * static_cast<float>(x), 2);
    return pixel;
  });
  for (const Pictures* pictures : {&even, &drawn}) {
    for (size_t i = 0; i < pictures->clean.size(); ++i) {
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(pictures->denoised[i][c], pictures->clean[i][c], 2e-3f * pictures->clean[i][c]) << i;
    }
  }
}

TEST_P(Denoise, TakesNoiseOffWallsSlantedOnesToo) {
  for (const float slope : {0.0f, 3.0f}) {
    const Pictures pictures = denoised([&](uint32_t x, uint32_t y) {
      Pixel pixel = wall(x, y);
      pixel.position.z -= slope * pixel.position.x;
      pixel.normal = glm::normalize(glm::vec3(slope, 0, 1));
      pixel.noise = 1;
      return pixel;
    });
    EXPECT_LT(4 * error(pictures.denoised, pictures.clean), error(pictures.noisy, pictures.clean)) << slope;
  }
}

// How much more light the right side has than the left one, in three columns on either side of the middle.
double step_height(const Pictures& pictures, const std::vector<glm::vec3>& picture) {
  double sum = 0;
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = side / 2 - 3; x < side / 2 + 3; ++x) {
      const double light = double(picture[y * side + x].y) / pictures.tint[y * side + x].y;
      sum += x < side / 2 ? -light : light;
    }
  }
  return sum / (3 * side);
}

// Noise as strong as the step, so that light alone cannot tell the sides apart: on one surface the step is
// worn down.
TEST_P(Denoise, KeepsEdgesOfGeometryAndAlbedo) {
  const auto step = [](uint32_t x, uint32_t y) {
    Pixel pixel = wall(x, y);
    pixel.light = glm::vec3(x < side / 2 ? 1 : 1.5f);
    pixel.noise = 1.5f;
    return pixel;
  };
  const auto lost = [&](const Scenery& scenery) {
    const Pictures pictures = denoised(scenery);
    return std::abs(step_height(pictures, pictures.denoised) - step_height(pictures, pictures.noisy)) /
           step_height(pictures, pictures.clean);
  };
  EXPECT_GT(lost(step), 0.3);
  EXPECT_LT(lost([&](uint32_t x, uint32_t y) {
              Pixel pixel = step(x, y);
              if (x >= side / 2) pixel.normal = {0.8f, 0, 0.6f};
              return pixel;
            }),
            0.15)
      << "bent";
  EXPECT_LT(lost([&](uint32_t x, uint32_t y) {
              Pixel pixel = step(x, y);
              if (x >= side / 2) pixel.position.z -= 60;
              return pixel;
            }),
            0.15)
      << "one behind the other";
  EXPECT_LT(lost([&](uint32_t x, uint32_t y) {
              Pixel pixel = step(x, y);
              pixel.albedo = x < side / 2 ? glm::vec3(0.9f, 0.9f, 0.9f) : glm::vec3(0.9f, 0.1f, 0);
              return pixel;
            }),
            0.15)
      << "painted";
}

// A texture is in the albedo, and comes back as sharp as it was.
TEST_P(Denoise, KeepsTextures) {
  const Pictures pictures = denoised([](uint32_t x, uint32_t y) {
    Pixel pixel = wall(x, y);
    pixel.albedo = glm::vec3((x + y) % 2 == 0 ? 0.4f : 0.6f);
    pixel.noise = 0.5f;
    return pixel;
  });
  EXPECT_LT(4 * error(pictures.denoised, pictures.clean), error(pictures.noisy, pictures.clean));
}

TEST_P(Denoise, LeavesWhatIsNoNumberWhereItIs) {
  const auto bad = [](uint32_t x, uint32_t y) {
    return (x == 9 && y == 9)     ? std::numeric_limits<float>::quiet_NaN()
           : (x == 20 && y == 13) ? std::numeric_limits<float>::infinity()
                                  : 0.0f;
  };
  const Pictures pictures = denoised([&](uint32_t x, uint32_t y) {
    Pixel pixel = wall(x, y);
    pixel.noise = 0.3f;
    if (bad(x, y) != 0) pixel.light.y = bad(x, y);
    return pixel;
  });
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x)
      EXPECT_EQ(std::isfinite(pictures.denoised[y * side + x].y), bad(x, y) == 0) << x << " " << y;
  }
}

TEST_P(Denoise, RefusesASingleSample) {
  const auto backend = open(GetParam());
  render::Settings settings;
  settings.denoise = true;
  EXPECT_THROW(render::Denoiser(*backend, settings, 64), Error);
}

INSTANTIATE_TEST_SUITE_P(, Denoise, testing::ValuesIn(device_names()),
                         [](const auto& each) { return each.param; });

class DenoisedPasses : public testing::TestWithParam<std::string> {};

render::Settings path_settings(uint32_t spp) {
  render::Settings settings;
  settings.width = 72;
  settings.height = 54;
  settings.integrator = render::Integrator::path;
  settings.spp = spp;
  return settings;
}

TEST_P(DenoisedPasses, GiveTheBitsOfTheCpu) {
  render::Settings settings = path_settings(3);
  settings.denoise = true;
  const ReadyScene ready("builtin:spheres");
  const auto device = open(GetParam(), {.validate = true}), cpu = open("cpu");
  render::ParityBackend both(*device, *cpu);
  picture(both, ready, 0.3f, settings);
  uint32_t rows = 0;
  for (const auto& row : both.differences()) {
    rows += row.pass == "denoise" ? 1 : 0;
    EXPECT_EQ(row.different, 0u) << row.pass << " " << row.buffer << " word " << row.first << std::hex << ": "
                                 << row.device_value << " against " << row.reference_value;
  }
  EXPECT_EQ(rows, 7u);
}

INSTANTIATE_TEST_SUITE_P(, DenoisedPasses, testing::ValuesIn(vulkan_device_names()),
                         [](const auto& each) { return each.param; });

double difference(const image::Image& a, const char* channel_a, const image::Image& b,
                  const char* channel_b) {
  double sum = 0;
  const std::vector<float>&x = a.find(channel_a)->values, &y = b.find(channel_b)->values;
  for (size_t i = 0; i < x.size(); ++i) sum += std::abs(double(x[i]) - y[i]);
  return sum / double(x.size());
}

TEST(DenoisedPictures, AreNearerToWhatManySamplesShow) {
  const auto cpu = cpu_fallback::make_cpu_backend({});
  ReadyScene ready("builtin:head");
  ASSERT_FALSE(ready.scene.cameras.empty());
  ready.scene.cameras[0].yfov *= 0.35f;  // features of the face span pixels enough
  render::Settings settings = path_settings(1024);
  settings.seed = 1;
  const image::Image reference = picture(*cpu, ready, 0, settings);
  settings = path_settings(8);
  settings.denoise = settings.noisy = true;
  const image::Image image = picture(*cpu, ready, 0, settings);
  EXPECT_LT(1.5 * difference(image, "G", reference, "G"), difference(image, "noisy.G", reference, "G"));
  // What has converged stays within the noise that it has left.
  settings.spp = 256;
  const image::Image converged = picture(*cpu, ready, 0, settings);
  EXPECT_LT(difference(converged, "G", converged, "noisy.G"),
            difference(converged, "noisy.G", reference, "G"));
}

}  // namespace
}  // namespace lodestone::test
