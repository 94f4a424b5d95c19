// SPDX-License-Identifier: MIT
// Atlases that were built before, one file each, named after everything that it was computed from.
#include <cstdlib>
#include <exception>
#include <optional>

#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/geometry_image/atlas.h"

namespace lodestone::geometry_image {
namespace {

namespace fs = std::filesystem;

fs::path variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// Empty where the environment names no place.
fs::path cache_folder() {
  if (const fs::path chosen = variable("LODESTONE_CACHE"); !chosen.empty()) return chosen;
  // A relative path there is to be ignored (XDG Base Directory Specification).
  if (const fs::path caches = variable("XDG_CACHE_HOME"); caches.is_absolute()) return caches / "lodestone";
  const fs::path home = variable("HOME");
  return home.empty() ? fs::path() : home / ".cache" / "lodestone";
}

std::optional<Atlas> find_cached(const fs::path& file, const std::string& hash,
                                 const scene::Assembly& assembly) {
  std::error_code failed;
  if (!fs::exists(file, failed)) return std::nullopt;
  try {
    BakeRecord stored;
    Atlas atlas = load_atlas(file, &stored);
    if (stored.content_hash == hash && atlas.report.triangles == assembly.triangles.size()) return atlas;
    log::note(file.string() + ": is the atlas of another scene; it is built again");
  } catch (const std::exception& error) {  // also where it claims more memory than there is
    log::note(std::string(error.what()) + "; it is built again");
  }
  return std::nullopt;
}

void keep(const fs::path& file, const Atlas& atlas, const std::string& hash) {
  try {
    save_atlas(file, atlas, {.content_hash = hash});
  } catch (const std::exception& error) {  // also of the file system's own kind
    log::note(std::string(error.what()) + "; the atlas is not kept");
  }
}

}  // namespace

Atlas cached_atlas(const scene::Scene& scene, const scene::Assembly& assembly, const AtlasSettings& settings,
                   bool* hit, const OnStage& on_stage) {
  if (hit != nullptr) *hit = false;
  const fs::path folder = cache_folder();
  if (folder.empty()) {
    log::note("no cache folder: set LODESTONE_CACHE to one");
    return build_atlas(scene, assembly, settings, on_stage);
  }
  const std::string hash = atlas_hash(scene, assembly, settings);
  const fs::path file = folder / ("atlas-" + hash + ".lode");
  if (std::optional<Atlas> found = find_cached(file, hash, assembly)) {
    if (hit != nullptr) *hit = true;
    return std::move(*found);
  }
  Atlas atlas = build_atlas(scene, assembly, settings, on_stage);
  keep(file, atlas, hash);
  return atlas;
}

}  // namespace lodestone::geometry_image
