// SPDX-License-Identifier: MIT
#include "lodestone/app/camera_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace lodestone::app {
namespace {

using glm::dmat4, glm::dvec3, glm::dvec4;

std::string text_of(const dmat4& matrix) {
  std::string text;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column)
      text += fmt::format("{}{}", text.empty() ? "" : " ", float(matrix[column][row]));
  }
  return text;
}

// For row vectors, row by row: as the columns of a matrix for column vectors lie in memory.
std::array<float, 16> for_rows(const dmat4& matrix) {
  std::array<float, 16> numbers;
  std::copy_n(glm::value_ptr(matrix), 16, numbers.begin());
  return numbers;
}

}  // namespace

void add_camera(const render::View& view, image::Image& image) {
  const dvec3 right = view.right, up = view.up, forward = view.forward, origin = view.origin;
  const double width = 2 * glm::length(right), height = 2 * glm::length(up);
  const dvec4 x(glm::normalize(right), 0), y(glm::normalize(up), 0), z(glm::normalize(forward), 0);
  image.metadata["lodestone:camera_to_world"] = text_of({x, y, -z, dvec4(origin, 1)});
  image.metadata["lodestone:projection"] =
      fmt::format("{} half_width={} half_height={}", view.perspective ? "perspective" : "orthographic",
                  float(width / 2), float(height / 2));

  // EXR looks along +Z, and has 0 to 1 from the upper left corner to the lower right one. Its z is nobody's:
  // 1 makes the matrix one that can be inverted.
  const dmat4 world_to_camera = glm::inverse(dmat4(x, y, z, dvec4(origin, 1)));
  const dmat4 perspective({1 / width, 0, 0, 0}, {0, -1 / height, 0, 0}, {0.5, 0.5, 0, 1}, {0, 0, 1, 0});
  const dmat4 orthographic({1 / width, 0, 0, 0}, {0, -1 / height, 0, 0}, {0, 0, 1, 0}, {0.5, 0.5, 0, 1});
  image.camera = {for_rows(world_to_camera),
                  for_rows((view.perspective ? perspective : orthographic) * world_to_camera)};
}

}  // namespace lodestone::app
