// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/screen_need.h"

#include <algorithm>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/base/parallel.h"
#include "lodestone/scene/pose.h"

namespace lodestone::geometry_image {

std::vector<ScreenView> screen_views(const scene::Scene& scene) {
  constexpr double usual_aspect = 16.0 / 9;
  const scene::Pose rest = scene::evaluate(scene, scene::none, 0);
  std::vector<ScreenView> views;
  for (size_t node = 0; node < scene.nodes.size(); ++node) {
    if (scene.nodes[node].camera == scene::none) continue;
    const scene::Camera& camera = scene.cameras[scene.nodes[node].camera];
    const glm::dmat4 world = rest.node_world[node];
    ScreenView view;
    view.origin = glm::dvec3(world[3]);
    view.right = glm::normalize(glm::dvec3(world[0]));
    view.up = glm::normalize(glm::dvec3(world[1]));
    view.forward = -glm::normalize(glm::dvec3(world[2]));
    view.perspective = camera.perspective;
    view.half_height = camera.perspective ? std::tan(0.5 * camera.yfov) : double(camera.ymag);
    const double aspect = camera.aspect > 0 ? camera.aspect : usual_aspect;
    view.half_width = camera.perspective ? view.half_height * aspect : double(camera.xmag);
    views.push_back(view);
  }
  if (views.empty()) {
    fail(ExitCode::usage, "--signal screen",
         "needs a camera in {}, which has none; use area or curvature, or add cameras to the file",
         scene.name);
  }
  return views;
}

double screen_size(const ScreenView& view, const glm::dvec3& point) {
  constexpr double unseen = 0.25, nearest = 1e-3;
  const glm::dvec3 offset = point - view.origin;
  const double distance = glm::length(offset), depth = glm::dot(offset, view.forward);
  const double scale = view.perspective ? depth : 1.0;
  const bool seen = depth > 0 && std::abs(glm::dot(offset, view.right)) <= scale * view.half_width &&
                    std::abs(glm::dot(offset, view.up)) <= scale * view.half_height;
  const double size = 1 / (view.half_height * (view.perspective ? std::max(distance, nearest) : 1.0));
  return std::isfinite(size) ? (seen ? size : unseen * size) : 0.0;
}

std::vector<double> screen_weights(const base_complex::BaseComplex& complex,
                                   const std::vector<ScreenView>& views) {
  constexpr double least = 1.0 / 16;
  constexpr uint64_t cells_a_task = 8;
  std::vector<double> weights(complex.cells.size(), 0);
  parallel_for(weights.size(), cells_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t c = begin; c < end; ++c)
      for (const uint32_t face : complex.cells[c].faces)
        for (const uint32_t point : complex.mesh.corners(face))
          for (const ScreenView& view : views)
            weights[c] = std::max(weights[c], screen_size(view, complex.mesh.position(point)));
  });
  const double largest = *std::max_element(weights.begin(), weights.end());
  for (double& weight : weights) weight = largest > 0 ? std::max(weight / largest, least) : 1.0;
  return weights;
}

}  // namespace lodestone::geometry_image
