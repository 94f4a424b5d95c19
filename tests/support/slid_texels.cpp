// SPDX-License-Identifier: MIT
#include "lodestone/test_support/slid_texels.h"

#include <bit>
#include <functional>

#include "lodestone/render/detail.h"
#include "lodestone/test_support/devices.h"

namespace lodestone::test {

std::vector<glm::vec3> slid_texels(const ReadyScene& ready, const std::vector<glm::vec3>& texels,
                                   const layout::RayCone& camera) {
  const auto backend = open("cpu");
  std::vector<glm::vec4> quads;
  for (const glm::vec3& texel : texels) quads.emplace_back(texel, 1.0f);
  const render::Buffer geometry(*backend, {"geometry", quads.size(), 16});
  backend->upload(geometry.id(), std::as_bytes(std::span(quads)));
  render::Detail detail(*backend, ready.assembly, ready.atlas, {});
  detail.build(geometry, render::steepest_cone(camera));
  std::vector<uint32_t> collapses(2 * texels.size());
  backend->download(detail.collapses().id(), std::as_writable_bytes(std::span(collapses)), 0);

  const layout::Tolerance tolerance{camera, layout::no_cone()};
  // All the way up, although no more than one parent should ever count.
  const std::function<glm::vec3(uint32_t)> place = [&](uint32_t texel) {
    const float radius = std::bit_cast<float>(collapses[2 * size_t(texel) + 1]);
    const float part = layout::collapse_of(layout::tolerance_at(tolerance, texels[texel]), radius);
    return part > 0 ? layout::slid(texels[texel], place(collapses[2 * size_t(texel)]), part) : texels[texel];
  };
  std::vector<glm::vec3> places;
  for (uint32_t i = 0; i < texels.size(); ++i) places.push_back(place(i));
  return places;
}

}  // namespace lodestone::test
