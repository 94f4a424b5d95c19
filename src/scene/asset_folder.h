// SPDX-License-Identifier: MIT
// The folder of a scene file: the only place from which the files that it names are opened.
#pragma once

#include <filesystem>
#include <string>

namespace lodestone::scene {

class AssetFolder {
 public:
  explicit AssetFolder(const std::filesystem::path& scene_file);

  // The file called `name` (relative; folders separated by / or \), resolved. Throws Error(bad_input), naming
  // the scene file, where the name is empty or absolute, climbs out with `..`, is led out by a symbolic link,
  // or where there is no such regular file.
  std::filesystem::path find(const std::string& name) const;

 private:
  std::string scene_file_;
  std::filesystem::path folder_;  // canonical
};

}  // namespace lodestone::scene
