// SPDX-License-Identifier: MIT
// A .lode file as a scene: it holds the atlas, and says which scene beside it that is of.
#pragma once

#include <filesystem>
#include <string>

#include "lodestone/app/common_options.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::app {

// Whether SCENE is a .lode file.
bool is_baked(const std::string& scene);

class BakedScene {
 public:
  // Reads the file. Throws Error(usage) where --height or --atlas contradict what was baked, Error(bad_input)
  // where it is damaged or does not say what it was baked from.
  explicit BakedScene(const SceneOptions& options);

  // Its scene, from the folder of the file or below, never from elsewhere. Throws Error(bad_input), naming
  // the file and the remedy, where it is not there.
  scene::Scene load() const;
  scene::Instancing instancing() const { return record_.instancing; }
  // The atlas; once. Throws Error(bad_input) where the scene is no longer the one that was baked.
  geometry_image::Atlas take_atlas(const scene::Scene& scene, const scene::Assembly& assembly);

 private:
  std::string file_;
  geometry_image::BakeRecord record_;
  geometry_image::Atlas atlas_;
};

// What a .lode at `output` records of its scene: a path relative to the folder of `output`, which must be
// there, where the scene lies in it or below, else the scene's file name. Warns where the scene could not be
// found so.
geometry_image::BakeRecord record_of(const SceneOptions& options, const std::filesystem::path& output,
                                     const std::string& content_hash);

}  // namespace lodestone::app
