// SPDX-License-Identifier: MIT
// Texture images through OpenImageIO, as RGBA8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// The largest image that is decoded: texels a side, and texels in all (512 MiB as RGBA8).
inline constexpr uint32_t max_image_side = 16384;
inline constexpr uint64_t max_image_texels = uint64_t(1) << 27;

// Decodes a PNG, JPEG or WebP held in memory, recognised by its first bytes, or any file that OpenImageIO
// reads. Grey is copied to R, G and B; a missing alpha is 255; alpha is never multiplied in; 16-bit and float
// samples are rounded to 8 bits; values are not converted between colour spaces. Image::name is left empty.
// `subject` names the image in errors. Throws Error(bad_input) where the image is broken, cut short or larger
// than the limits above, or claims more texels than its bytes can hold.
Image decode_image(std::span<const std::byte> bytes, const std::string& subject);
Image decode_image_file(const std::filesystem::path& path);

}  // namespace lodestone::scene
