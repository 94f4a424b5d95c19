// SPDX-License-Identifier: MIT
// The register of the built-in scenes.
#include <algorithm>
#include <array>

#include "lodestone/base/error.h"
#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/load.h"

namespace lodestone::scene {
namespace {

struct Entry {
  const char* name;
  Scene (*make)();
};

constexpr std::array<Entry, 6> entries = {{{"head", builtin::make_head},
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

Scene make_builtin(const std::string& name) {
  const auto* entry =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return name == e.name; });
  if (entry == entries.end()) {
    std::string known;
    for (const std::string& n : builtin_names()) known += (known.empty() ? "" : ", ") + n;
    fail(ExitCode::usage, "builtin:" + name, "no built-in scene has this name; there are {}", known);
  }
  Scene scene = entry->make();
  scene.name = "builtin:" + name;
  validate(scene);
  return scene;
}

}  // namespace lodestone::scene
