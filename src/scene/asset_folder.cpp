// SPDX-License-Identifier: MIT
#include "lodestone/scene/asset_folder.h"

#include <algorithm>
#include <system_error>

#include "lodestone/base/error.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace fs = std::filesystem;
namespace {

constexpr size_t longest_shown = 120;

bool is_inside(const fs::path& folder, const fs::path& file) {
  const auto [end_of_folder, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end_of_folder == folder.end() && rest != file.end();
}

}  // namespace

AssetFolder::AssetFolder(const fs::path& scene_file) : scene_file_(scene_file.string()) {
  const fs::path parent = scene_file.parent_path();
  std::error_code failed;
  folder_ = fs::canonical(parent.empty() ? fs::path(".") : parent, failed);
  if (failed) fail_input(scene_file_, "its folder cannot be opened: {}", failed.message());
}

fs::path AssetFolder::find(const std::string& name) const {
  if (name.empty()) fail_input(scene_file_, "names a file without giving its name; re-export the scene");
  if (name.find('\0') != std::string::npos)
    fail_input(scene_file_, "names the file '{}', which cannot exist", shown(name, longest_shown));
  std::string separated = name;
  std::replace(separated.begin(), separated.end(), '\\', '/');
  const fs::path relative(separated);
  const bool climbs = std::find(relative.begin(), relative.end(), fs::path("..")) != relative.end();
  const bool has_drive = separated.size() > 1 && separated[1] == ':';
  if (relative.is_absolute() || has_drive || climbs) {
    fail_input(scene_file_, "names the file '{}' outside its own folder; put the file beside the scene",
               shown(name, longest_shown));
  }
  std::error_code failed;
  const fs::path resolved = fs::canonical(folder_ / relative, failed);
  if (failed) {
    fail_input(scene_file_, "names the file '{}', which cannot be opened ({}); put it beside the scene",
               shown(name, longest_shown), failed.message());
  }
  if (!is_inside(folder_, resolved)) {
    fail_input(scene_file_,
               "names the file '{}', a link that leads out of the scene's folder; copy the file there",
               shown(name, longest_shown));
  }
  if (!fs::is_regular_file(resolved, failed)) {
    fail_input(scene_file_, "names '{}', which is not a regular file", shown(name, longest_shown));
  }
  return resolved;
}

}  // namespace lodestone::scene
