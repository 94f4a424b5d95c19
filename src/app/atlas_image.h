// SPDX-License-Identifier: MIT
// The atlas as pictures: `bake --atlas-image`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lodestone/app/output_path.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::app {

inline constexpr const char* atlas_image_help =
    "Draw the charts, a texel a pixel and grown until they can be seen: NAME-positions.png, "
    "NAME-normals.png, "
    "NAME-charts.png, NAME-stretch.png (.exr: the numbers themselves)";
inline constexpr const char* stretch_help =
    "Stretch in pictures of an atlas is the L2 stretch of the quads round a texel in the rest pose: 1 is a "
    "square\n"
    "quad of the mean size, more is fewer texels. Colours go from 0.5 (black) to 3 (pale yellow) by the "
    "logarithm.\n";

class AtlasImageFiles {
 public:
  // NAME.png or NAME.exr; empty: does nothing. Throws Error(usage) for other extensions.
  explicit AtlasImageFiles(const std::string& name);

  // Throws Error(usage) where one of them is `scene`, Error(machine) where one cannot be written.
  void check(const std::string& scene) const;
  // Draws the rest pose. Returns a line about it for people.
  std::string write(const scene::Scene& scene, const scene::Assembly& assembly,
                    const geometry_image::Atlas& atlas) const;

  bool empty() const { return name_.empty(); }

 private:
  std::filesystem::path path(const char* what) const;

  std::filesystem::path name_;
};

}  // namespace lodestone::app
