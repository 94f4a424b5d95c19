// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace lodestone::image {

// Throws Error(bad_input) where a file that begins as a PNG is cut short or a checksum is wrong; leaves all
// other files alone. OpenImageIO would notice most of it too, but libpng prints about it, and what lies
// behind the pixels would not be missed.
void check_png(const std::filesystem::path& path);

}  // namespace lodestone::image
