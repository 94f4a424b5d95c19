// SPDX-License-Identifier: MIT
#include "lodestone/test_support/environments.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace lodestone::test {
namespace {

glm::vec3 sunny_radiance(double u, double v) {
  if (u < 0.05 || u > 0.95) return glm::vec3(0);
  const bool odd = (static_cast<int>(u * 24) + static_cast<int>(v * 12)) % 2 != 0;
  if (v > 0.4 && v < 0.6) return odd ? glm::vec3(0.9f, 0.5f, 0.2f) : glm::vec3(0.1f, 0.3f, 0.4f);
  const auto down = static_cast<float>(v);
  return v < 0.5 ? glm::vec3(0.2f + down, 0.4f + down, 1.0f) : glm::vec3(0.3f - 0.2f * down);
}

}  // namespace

glm::dvec3 direction_at(double u, double v) {
  const double around = 2 * std::numbers::pi * (u - 0.5), down = std::numbers::pi * v;
  return {std::cos(around) * std::sin(down), std::cos(down), std::sin(around) * std::sin(down)};
}

scene::Environment sunny_environment(uint32_t width, uint32_t height, uint32_t sun) {
  scene::Environment environment;
  environment.file = "sunny";
  environment.width = width;
  environment.height = height;
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x)
      environment.radiance.push_back(sunny_radiance((x + 0.5) / width, (y + 0.5) / height));
  }
  for (uint32_t y = 0; y < sun; ++y) {
    for (uint32_t x = 0; x < sun; ++x)
      environment.radiance[size_t(height * 3 / 10 + y) * width + width / 3 + x] = glm::vec3(6000, 5000, 4000);
  }
  return environment;
}

scene::Environment even_environment(uint32_t width, uint32_t height, const glm::vec3& radiance) {
  scene::Environment environment;
  environment.file = "even";
  environment.width = width;
  environment.height = height;
  environment.radiance.assign(size_t(width) * height, radiance);
  return environment;
}

scene::Scene scene_in(scene::Environment environment) {
  scene::Scene scene;
  scene.name = environment.file;
  scene.environment = std::move(environment);
  return scene;
}

}  // namespace lodestone::test
