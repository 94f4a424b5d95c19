// SPDX-License-Identifier: MIT
#include "lodestone/test_support/picture.h"

#include "lodestone/render/view.h"

namespace lodestone::test {

image::Image picture(render::Backend& backend, const ReadyScene& ready, float time,
                     const render::Settings& settings) {
  render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, settings);
  const scene::Pose pose = ready.pose(time);
  const auto bounds = scene::pose_bounds(ready.scene, pose);
  const auto view = render::find_view(ready.scene, pose, "", bounds, settings.width, settings.height);
  return renderer.render(pose, view)->linear;
}

float value(const image::Image& image, const char* channel, uint32_t x, uint32_t y) {
  return image.find(channel)->values[size_t(y) * image.width + x];
}

}  // namespace lodestone::test
