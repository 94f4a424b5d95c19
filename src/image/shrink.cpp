// SPDX-License-Identifier: MIT
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <new>

#include "lodestone/image/image.h"

namespace lodestone::image {

Image shrunk(const Image& image, uint32_t longest) {
  const uint32_t factor = (std::max(image.width, image.height) + longest - 1) / longest;
  if (factor <= 1) return image;
  Image small;
  small.width = (image.width + factor - 1) / factor;
  small.height = (image.height + factor - 1) / factor;
  small.linear = image.linear;
  const OIIO::ImageSpec from(int(image.width), int(image.height), 1, OIIO::TypeFloat);
  const OIIO::ImageSpec to(int(small.width), int(small.height), 1, OIIO::TypeFloat);
  for (const Channel& channel : image.channels) {
    std::vector<float> values = channel.values;  // a buffer that is wrapped must not be const
    const OIIO::ImageBuf source(from, values.data());
    OIIO::ImageBuf target(to, small.add(channel.name).values.data());
    if (!OIIO::ImageBufAlgo::resize(target, source, "box")) throw std::bad_alloc();
  }
  return small;
}

}  // namespace lodestone::image
