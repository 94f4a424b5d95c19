// SPDX-License-Identifier: MIT
// Cameras and lights of a frame, from the scene's nodes at a pose.
#pragma once

#include <vector>

#include "lodestone/layout/frame.h"
#include "lodestone/render/renderer.h"

namespace lodestone::render {

// Every light that is not black, the sky last where there is one. A scene that says nothing about light gets
// a soft sky and a key light from above the camera's left shoulder. An environment map is the sky.
std::vector<layout::LightRecord> frame_lights(const scene::Scene& scene, const scene::Pose& pose,
                                              const View& view, scene::Sky& sky);

// That sky, which is the same in every frame.
scene::Sky frame_sky(const scene::Scene& scene);

}  // namespace lodestone::render
