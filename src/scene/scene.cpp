// SPDX-License-Identifier: MIT
#include "lodestone/scene/scene.h"

#include <algorithm>

namespace lodestone::scene {

float Animation::duration() const {
  float last = 0;
  for (const Channel& channel : channels) {
    if (!channel.times.empty()) last = std::max(last, channel.times.back());
  }
  return last;
}

std::array<const Texture*, 11> Material::textures() const {
  return {&base_color_texture,          &metallic_roughness_texture, &normal_texture,
          &occlusion_texture,           &emissive_texture,           &specular_texture,
          &specular_color_texture,      &transmission_texture,       &clearcoat_texture,
          &clearcoat_roughness_texture, &clearcoat_normal_texture};
}

}  // namespace lodestone::scene
