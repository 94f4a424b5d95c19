// SPDX-License-Identifier: MIT
// A first look at an OpenEXR file. The library makes room for whatever size an attribute of the header
// claims, up to 2 GiB, before it finds out that the file ends.
#pragma once

#include <string>
#include <string_view>

namespace lodestone::scene {

// Throws Error(bad_input), naming `file` and the byte, unless the bytes begin with the header of a single
// image that is not deep, and each of its attributes fits into the file and has the size of its type. Values
// are not looked at.
void check_exr_header(const std::string& file, std::string_view bytes);

}  // namespace lodestone::scene
