// SPDX-License-Identifier: MIT
// Cameras (3.10) and KHR_lights_punctual.
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/scene/gltf_convert.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

Camera convert_camera(const AccessorReader& reader, size_t index) {
  const tinygltf::Camera& from = reader.model().cameras[index];
  const std::string label = gltf_label("camera", index, from.name);
  Camera to;
  to.name = from.name;
  to.perspective = from.type == "perspective";
  const auto number = [&](double value) { return gltf_float(reader, value, label); };
  if (to.perspective) {
    to.yfov = number(from.perspective.yfov);
    to.aspect = number(from.perspective.aspectRatio);
    to.znear = number(from.perspective.znear);
    to.zfar = number(from.perspective.zfar);
    if (to.znear <= 0) fail_input(reader.file(), "{}: znear must be greater than 0; export it again", label);
  } else {
    // A negative extent mirrors nothing that could be seen: it is the half width that counts.
    to.xmag = std::abs(number(from.orthographic.xmag));
    to.ymag = std::abs(number(from.orthographic.ymag));
    to.znear = number(from.orthographic.znear);
    to.zfar = number(from.orthographic.zfar);
  }
  const bool far_is_given = !to.perspective || to.zfar != 0;
  if (far_is_given && to.zfar <= to.znear) {
    fail_input(reader.file(), "{}: zfar must be greater than znear; export it again", label);
  }
  return to;
}

Light::Kind light_kind(const AccessorReader& reader, const std::string& type, const std::string& label) {
  if (type == "directional") return Light::Kind::directional;
  if (type == "point") return Light::Kind::point;
  if (type == "spot") return Light::Kind::spot;
  fail_input(reader.file(), "{}: a light of type '{}' does not exist; export it again", label,
             printable(type));
}

Light convert_light(const AccessorReader& reader, size_t index) {
  const tinygltf::Light& from = reader.model().lights[index];
  const std::string label = gltf_label("light", index, from.name);
  Light to;
  to.name = from.name;
  to.kind = light_kind(reader, from.type, label);
  const std::vector<float> color = gltf_floats(reader, from.color, label + ", color");
  if (!color.empty() && color.size() != 3) {
    fail_input(reader.file(), "{}: a colour of {} numbers instead of 3; export it again", label,
               color.size());
  }
  if (!color.empty()) to.color = {color[0], color[1], color[2]};
  to.intensity = gltf_float(reader, from.intensity, label + ", intensity");
  to.range = gltf_float(reader, from.range, label + ", range");
  if (to.kind == Light::Kind::spot) {
    to.inner_cone = gltf_float(reader, from.spot.innerConeAngle, label + ", innerConeAngle");
    to.outer_cone = gltf_float(reader, from.spot.outerConeAngle, label + ", outerConeAngle");
    constexpr float right_angle = 1.5707964f;
    // They should differ, but exporters write a hard edge as two equal angles.
    if (!(0 <= to.inner_cone && to.inner_cone <= to.outer_cone && to.outer_cone > 0 &&
          to.outer_cone <= right_angle)) {
      fail_input(reader.file(), "{}: cone angles {} and {} must ascend between 0 and pi/2; export it again",
                 label, to.inner_cone, to.outer_cone);
    }
  }
  return to;
}

}  // namespace

std::vector<Camera> convert_cameras(const AccessorReader& reader) {
  std::vector<Camera> cameras;
  for (size_t i = 0; i < reader.model().cameras.size(); ++i) cameras.push_back(convert_camera(reader, i));
  return cameras;
}

std::vector<Light> convert_lights(const AccessorReader& reader) {
  std::vector<Light> lights;
  for (size_t i = 0; i < reader.model().lights.size(); ++i) lights.push_back(convert_light(reader, i));
  return lights;
}

}  // namespace lodestone::scene
