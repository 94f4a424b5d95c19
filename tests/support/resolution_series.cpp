// SPDX-License-Identifier: MIT
#include "lodestone/test_support/resolution_series.h"

#include "lodestone/base/error.h"
#include "lodestone/geometry_image/fidelity.h"
#include "lodestone/image/compare.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

image::Image displayed(const ReadyScene& ready, const SeriesPicture& picture, render::Backend& backend) {
  render::Settings settings;
  settings.width = settings.height = picture.size;
  settings.spp = picture.spp;
  const scene::Pose rest = scene::evaluate(ready.scene, scene::none, 0);
  const auto view = render::find_view(ready.scene, rest, picture.camera,
                                      scene::pose_bounds(ready.scene, rest), picture.size, picture.size);
  render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, settings);
  return renderer.render(rest, view)->display;
}

}  // namespace

std::vector<SeriesPoint> resolution_series(const scene::Scene& scene,
                                           const std::vector<uint32_t>& resolutions,
                                           const SeriesPicture& picture, render::Backend& backend) {
  const image::Image reference =
      displayed(ReadyScene(scene, geometry_image::AtlasKind::exact), picture, backend);
  std::vector<SeriesPoint> series;
  for (const uint32_t resolution : resolutions) {
    geometry_image::AtlasSettings settings(geometry_image::AtlasKind::charts);
    settings.charts.texel_budget = uint64_t(resolution) * resolution;
    const ReadyScene charts(scene, settings);
    const auto fidelity = geometry_image::measure_fidelity(charts.scene, charts.assembly, charts.atlas,
                                                           scene::evaluate(scene, scene::none, 0));
    if (!fidelity) fail_input(scene.name, "nothing of it can be resampled, so it has no series");
    const image::Comparison pictures = image::compare(reference, displayed(charts, picture, backend), {});
    series.push_back({resolution, charts.atlas.report.texels, charts.atlas.charts.size(),
                      fidelity->from_input, fidelity->from_image, fidelity->hausdorff(),
                      fidelity->root_mean_square, pictures.mean, pictures.flip_mean.value()});
  }
  return series;
}

}  // namespace lodestone::test
