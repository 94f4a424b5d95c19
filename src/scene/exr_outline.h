// SPDX-License-Identifier: MIT
// A first look at an OpenEXR file. The library makes room for whatever size an attribute of the header
// claims, up to 2 GiB, before it finds out that the file ends.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lodestone::scene {

struct ExrOutline {
  // Of the data window; 0 where the header has none or an empty one.
  uint64_t width = 0, height = 0;
  uint64_t texel_bytes = 0;  // of all channels
};

// Throws Error(bad_input), naming `file` and the byte, unless the bytes begin with the header of a single
// image that is not deep, and each of its attributes fits into the file and has the size of its type.
ExrOutline read_exr_outline(const std::string& file, std::string_view bytes);

}  // namespace lodestone::scene
