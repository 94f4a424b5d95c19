// SPDX-License-Identifier: MIT
// What the colours of a picture mean, in the picture.
#pragma once

#include <string>
#include <vector>

#include "lodestone/image/image.h"

namespace lodestone::image {

struct Mark {
  float place = 0;  // 0..1 along the scale
  std::string label;
};

// The R G B of the picture with a strip below that shows all colours of heat() (colour_map.h) and what stands
// for which: printable ASCII.
Image with_colour_scale(const Image& picture, const std::string& title, const std::vector<Mark>& marks);

}  // namespace lodestone::image
