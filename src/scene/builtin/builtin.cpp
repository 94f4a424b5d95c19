// SPDX-License-Identifier: MIT
// The register of the built-in scenes.
#include <algorithm>
#include <array>
#include <charconv>

#include "lodestone/base/error.h"
#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/load.h"

namespace lodestone::scene {
namespace {

struct Entry {
  const char* name;
  Scene (*make)();
};

constexpr std::array<Entry, 7> entries = {{{"head", builtin::make_head},
                                           {"room", builtin::make_room},
                                           {"shoal", builtin::make_shoal},
                                           {"spheres", builtin::make_spheres},
                                           {"teapots", builtin::make_teapots},
                                           {"terrain", builtin::make_terrain},
                                           {"tiny", builtin::make_tiny}}};

}  // namespace

std::vector<std::string> builtin_names() {
  std::vector<std::string> names;
  for (const Entry& entry : entries) names.emplace_back(entry.name);
  return names;
}

namespace {

constexpr std::string_view terrain_prefix = "terrain:";

// NAME of builtin:NAME is terrain:QUADS.
Scene make_sized_terrain(const std::string& name) {
  const std::string_view digits = std::string_view(name).substr(terrain_prefix.size());
  uint32_t quads = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), quads);
  if (error != std::errc() || end != digits.data() + digits.size() || quads < builtin::least_terrain ||
      quads > builtin::largest_terrain) {
    fail(ExitCode::usage, "builtin:" + name, "`{}` is not a number of quads a side from {} to {}", digits,
         builtin::least_terrain, builtin::largest_terrain);
  }
  Scene scene = builtin::make_large_terrain(quads);
  scene.name = "builtin:" + name;
  return scene;
}

}  // namespace

Scene make_builtin(const std::string& name) {
  if (name.starts_with(terrain_prefix)) {
    Scene scene = make_sized_terrain(name);
    validate(scene);
    return scene;
  }
  const auto* entry =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return name == e.name; });
  if (entry == entries.end()) {
    std::string known;
    for (const std::string& n : builtin_names()) known += (known.empty() ? "" : ", ") + n;
    fail(ExitCode::usage, "builtin:" + name,
         "no built-in scene has this name; there are {}, and terrain:QUADS, so many a side", known);
  }
  Scene scene = entry->make();
  scene.name = "builtin:" + name;
  validate(scene);
  return scene;
}

}  // namespace lodestone::scene
