// SPDX-License-Identifier: MIT
// A scene made ready to trace: read, assembled, its atlas at hand, its animation chosen.
#pragma once

#include <string>
#include <vector>

#include "lodestone/app/common_options.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/render/renderer.h"
#include "lodestone/report/measurements.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/pose.h"
#include "lodestone/scene/scene.h"

namespace lodestone::app {

struct PreparedScene {
  scene::Scene scene;
  scene::Assembly assembly;
  geometry_image::Atlas atlas;
  uint32_t animation = scene::none;
  PoseOptions pose;
  std::vector<report::Stage> stages;  // what it took

  // A clip loops: seconds past its end go back to its beginning. Without a clip every time is 0.
  double wrap(double seconds) const;
  // The pose at a wrapped time, the weights of the command line on top.
  scene::Pose pose_at(double seconds) const;
  // What a camera that frames everything must see. Costly; asked for only where one is needed.
  scene::Bounds bounds() const;
  std::string clip_name() const;  // "" without an animation
};

// Of a .lode file: the scene that it was baked from, with the atlas in the file. scene.name is the file that
// was read. Throws Error(bad_input) and Error(usage) of the loaders. `show_stages`: on a terminal, while an
// atlas is built.
PreparedScene prepare_scene(const SceneOptions& scene, const PoseOptions& pose, bool show_stages = true);

// The view of one frame; bounds may be empty where none are needed.
render::View view_of(const PreparedScene& prepared, const scene::Pose& pose, const PictureOptions& picture,
                     const scene::Bounds& bounds);

}  // namespace lodestone::app
