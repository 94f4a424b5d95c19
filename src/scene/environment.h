// SPDX-License-Identifier: MIT
// Environment maps from files.
#pragma once

#include <filesystem>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// Reads an equirectangular picture: Radiance .hdr, OpenEXR, PNG or JPEG, recognised by its first bytes. The
// first two are taken as linear, the others as encoded by sRGB; primaries are those of Rec. 709; grey becomes
// R = G = B; alpha is passed over. Warns where the width is not twice the height. Throws Error(bad_input)
// with file, place and remedy where it is no such picture, truncated, larger than max_environment_width x
// max_environment_height, or claims more texels than its bytes can hold; where its channels are neither grey
// nor red, green and blue; and where a sample is negative, not finite or above 1e30.
Environment load_environment(const std::filesystem::path& path);

}  // namespace lodestone::scene
