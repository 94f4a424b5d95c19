// SPDX-License-Identifier: MIT
// Materials of an OBJ file: the MTL files beside it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/scene/asset_folder.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// Gathers the materials of all MTL files that one OBJ file names, and the images that those name. What cannot
// be found or is not understood is a warning: geometry alone is worth rendering. What is there but damaged is
// an error.
class ObjMaterials {
 public:
  explicit ObjMaterials(const std::filesystem::path& obj_file);

  // Reads the MTL file called `name`, once. A missing one, or one outside the folder, is a warning. Throws
  // Error(bad_input) where the file is there but malformed.
  void read_library(const std::string& name);

  // The index of the material, `none` (with a warning) where no library has it. Of equal names the first
  // counts.
  uint32_t find(std::string_view name);

  // Moves everything into the scene.
  void move_to(Scene& scene);

 private:
  friend class MtlParser;
  // The index of the image called `name`; `none` (with a warning) where it cannot be found. Throws
  // Error(bad_input) where it cannot be decoded.
  uint32_t image(const std::string& name);
  // Warns of the first few things only; a file may give cause for millions of warnings.
  void warn(const std::string& message);
  // Warns where `keyword` was not warned of before.
  void warn_once(std::string_view keyword, const std::string& message);

  std::string obj_file_;
  AssetFolder folder_;
  std::map<std::filesystem::path, uint32_t> images_by_path_;
  std::set<std::string> libraries_;  // asked for so far
  bool misses_library_ = false;
  size_t warnings_ = 0;
  std::set<std::string, std::less<>> keywords_;  // warned of
  std::set<std::string, std::less<>> unknown_;   // materials warned of
  std::map<std::string, uint32_t, std::less<>> materials_by_name_;
  std::vector<Material> materials_;
  std::vector<Image> images_;
};

}  // namespace lodestone::scene
