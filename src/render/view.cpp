// SPDX-License-Identifier: MIT
#include "lodestone/render/view.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/scene/pose_reach.h"

namespace lodestone::render {
namespace {

using glm::vec3;

View scene_view(const scene::Scene& scene, const scene::Pose& pose, uint32_t node, float aspect) {
  const scene::Camera& camera = scene.cameras[scene.nodes[node].camera];
  const glm::mat4& world = pose.node_world[node];
  const vec3 x = glm::normalize(vec3(world[0])), y = glm::normalize(vec3(world[1])),
             z = glm::normalize(vec3(world[2]));
  View view;
  view.name = camera.name.empty() ? scene.nodes[node].name : camera.name;
  view.origin = vec3(world[3]);
  view.forward = -z;
  view.perspective = camera.perspective;
  if (camera.perspective) {
    const float half = std::tan(camera.yfov / 2);
    view.up = y * half;
    view.right = x * (half * aspect);
  } else {
    view.up = y * camera.ymag;
    view.right = x * (camera.ymag * aspect);
  }
  return view;
}

// A node that is scaled to nothing, or placed beyond all numbers, shows nothing and says nothing.
View checked(const scene::Scene& scene, View view) {
  // Written so that what is no number fails.
  const auto has_length = [](const vec3& v) { return glm::dot(v, v) > 0; };
  const bool has_size = has_length(view.right) && has_length(view.up) && has_length(view.forward);
  const vec3 all = glm::abs(view.origin) + glm::abs(view.right) + glm::abs(view.up) + glm::abs(view.forward);
  if (!has_size || !(all.x + all.y + all.z <= 10 * scene::largest_reach)) {
    fail_input(scene.name, "camera {} has no size or lies too far out to see; use another --camera, or auto",
               view.name.empty() ? "(without a name)" : view.name);
  }
  return view;
}

// From the front, a little from above and from the right.
const vec3 auto_back(0.35f, 0.28f, 1.0f);
constexpr float auto_field_of_view = 0.6f;

vec3 orbit_back(const glm::vec2& degrees) {
  const float azimuth = glm::radians(degrees.x), elevation = glm::radians(degrees.y);
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

// Two directions square to `back`, the second as upright as can be.
void find_axes(const vec3& back, vec3& right, vec3& up) {
  const vec3 vertical = std::abs(back.y) > 0.99999f ? vec3(0, 0, back.y > 0 ? -1 : 1) : vec3(0, 1, 0);
  right = glm::normalize(glm::cross(vertical, back));
  up = glm::cross(back, right);
}

// As near as all corners of the bounds allow.
View auto_view(const scene::Bounds& bounds, float aspect, const vec3& toward_camera, float field_of_view) {
  const vec3 lo = bounds.empty ? vec3(-1) : bounds.lo, hi = bounds.empty ? vec3(1) : bounds.hi;
  const vec3 center = (lo + hi) * 0.5f;
  const float size = std::max(glm::length(hi - lo), scene::smallest_reach);
  const vec3 back = glm::normalize(toward_camera);
  vec3 right, up;
  find_axes(back, right, up);
  const float half = std::tan(0.5f * field_of_view);
  const float half_x = half * aspect;
  float distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const vec3 p =
        vec3(corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z) - center;
    const float along = glm::dot(p, back);
    distance = std::max(distance, along + std::abs(glm::dot(p, right)) / half_x);
    distance = std::max(distance, along + std::abs(glm::dot(p, up)) / half);
  }
  View view;
  view.name = "auto";
  view.origin = center + back * (distance * 1.04f + size * 1e-3f);
  view.forward = -back;
  view.right = right * half_x;
  view.up = up * half;
  return view;
}

layout::LightRecord light_record(const scene::Light& light, const glm::mat4& world) {
  layout::LightRecord record{};
  switch (light.kind) {
    case scene::Light::Kind::directional:
      record.kind = layout::light_directional;
      break;
    case scene::Light::Kind::point:
      record.kind = layout::light_point;
      break;
    case scene::Light::Kind::spot:
      record.kind = layout::light_spot;
      break;
  }
  record.position = vec3(world[3]);
  const vec3 back = vec3(world[2]);
  record.direction = glm::dot(back, back) > 0 ? -glm::normalize(back) : vec3(0, 0, -1);
  record.range = light.range;
  record.color = light.color * light.intensity;
  const float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
  record.cone_scale = 1.0f / std::max(inner - outer, 1e-3f);
  record.cone_offset = -outer * record.cone_scale;
  return record;
}

// With another angle from bottom to top.
View widened(View view, float field_of_view) {
  if (!view.perspective)
    fail(ExitCode::usage, "--fov", "camera {} is orthographic and has none; use another --camera, or auto",
         view.name.empty() ? "(without a name)" : view.name);
  const float scale = std::tan(0.5f * field_of_view) / glm::length(view.up);
  view.right *= scale;
  view.up *= scale;
  return view;
}

View named_view(const scene::Scene& scene, const scene::Pose& pose, const CameraChoice& choice,
                const scene::Bounds& bounds, float aspect) {
  const std::string& name = choice.name;
  const float field_of_view = choice.field_of_view ? glm::radians(*choice.field_of_view) : auto_field_of_view;
  const auto framed = [&] {
    return checked(scene, auto_view(bounds, aspect, choice.orbit ? orbit_back(*choice.orbit) : auto_back,
                                    field_of_view));
  };
  if (name == "auto" || choice.orbit) return framed();
  uint32_t number = 0;
  const bool numeric = !name.empty() && std::from_chars(name.data(), name.data() + name.size(), number).ptr ==
                                            name.data() + name.size();
  std::string known;
  uint32_t index = 0;
  for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
    if (scene.nodes[node].camera == scene::none) continue;
    View view = scene_view(scene, pose, node, aspect);
    if (name.empty() || view.name == name || scene.nodes[node].name == name || (numeric && index == number)) {
      view = checked(scene, view);
      return choice.field_of_view ? widened(view, field_of_view) : view;
    }
    known += (known.empty() ? "" : ", ") + (view.name.empty() ? std::to_string(index) : view.name);
    ++index;
  }
  if (name.empty()) return framed();
  if (known.empty())
    fail(ExitCode::usage, "--camera " + name,
         "the scene has no camera of its own; leave the option out, or give auto");
  fail(ExitCode::usage, "--camera " + name, "no such camera; there are: {}, auto", known);
}

// Elsewhere, and upright.
View placed(View view, const CameraChoice& choice, const scene::Bounds& bounds) {
  view.origin = choice.from.value_or(view.origin);
  const vec3 target = choice.at.value_or(bounds.empty ? vec3(0) : (bounds.lo + bounds.hi) * 0.5f);
  const vec3 back = view.origin - target;
  if (!(glm::length(back) > scene::smallest_reach))
    fail(ExitCode::usage, choice.at ? "--camera-at" : "--camera-from",
         "is the very place that the camera stands at and looks at; give two places");
  vec3 right, up;
  find_axes(glm::normalize(back), right, up);
  view.right = right * glm::length(view.right);
  view.up = up * glm::length(view.up);
  view.forward = -glm::normalize(back);
  return view;
}

}  // namespace

bool CameraChoice::needs_bounds(const scene::Scene& scene) const {
  return name == "auto" || orbit || (name.empty() && scene.cameras.empty()) || (from && !at);
}

View find_view(const scene::Scene& scene, const scene::Pose& pose, const CameraChoice& choice,
               const scene::Bounds& bounds, uint32_t width, uint32_t height) {
  if (choice.orbit && (choice.from || !(choice.name.empty() || choice.name == "auto")))
    fail(ExitCode::usage, "--orbit", "goes round what --camera auto frames; leave out {}",
         choice.from ? "--camera-from" : "the other --camera");
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const View view = named_view(scene, pose, choice, bounds, aspect);
  return choice.from || choice.at ? checked(scene, placed(view, choice, bounds)) : view;
}

View find_view(const scene::Scene& scene, const scene::Pose& pose, const std::string& name,
               const scene::Bounds& bounds, uint32_t width, uint32_t height) {
  CameraChoice choice;
  choice.name = name;
  return find_view(scene, pose, choice, bounds, width, height);
}

scene::Sky frame_sky(const scene::Scene& scene) {
  const bool lit = std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const scene::Node& node) {
    return node.light != scene::none &&
           scene.lights[node.light].color * scene.lights[node.light].intensity != vec3(0);
  });
  if (lit || scene.sky || scene.environment) return scene.sky.value_or(scene::Sky{});
  return {vec3(0.36f, 0.42f, 0.54f), vec3(0.48f, 0.49f, 0.5f), vec3(0.15f, 0.135f, 0.12f)};
}

std::vector<layout::LightRecord> frame_lights(const scene::Scene& scene, const scene::Pose& pose,
                                              const View& view, scene::Sky& sky) {
  std::vector<layout::LightRecord> lights;
  for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
    if (scene.nodes[node].light == scene::none) continue;
    const auto record = light_record(scene.lights[scene.nodes[node].light], pose.node_world[node]);
    if (record.color != vec3(0)) lights.push_back(record);
  }
  sky = frame_sky(scene);
  if (lights.empty() && !scene.sky && !scene.environment) {
    layout::LightRecord key{};
    key.kind = layout::light_directional;
    key.direction = glm::normalize(glm::normalize(view.forward) + 0.6f * glm::normalize(view.right) -
                                   0.9f * glm::normalize(view.up));
    key.color = vec3(1.7f, 1.6f, 1.45f);
    lights.push_back(key);
  }
  if (lights.empty() || scene.environment || sky.top != vec3(0) || sky.horizon != vec3(0) ||
      sky.bottom != vec3(0)) {
    layout::LightRecord record{};
    record.kind = layout::light_sky;
    lights.push_back(record);
  }
  return lights;
}

}  // namespace lodestone::render
