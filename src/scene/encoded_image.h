// SPDX-License-Identifier: MIT
// Damage to PNG and JPEG files that their decoders let pass, or report past us.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lodestone::scene {

// Throws Error(bad_input) where the bytes open like a PNG but its chunks are cut short or fail their
// checksums, or like a JPEG but its end is missing. Bytes of any other format pass. `subject` names the image
// in errors.
//
// Beyond the better message: libpng prints its errors itself, OpenImageIO loses memory where a PNG is cut
// short, and fills what is missing of a JPEG with grey.
void check_encoded_image(std::span<const std::byte> bytes, const std::string& subject);

}  // namespace lodestone::scene
