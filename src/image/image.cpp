// SPDX-License-Identifier: MIT
#include "lodestone/image/image.h"

#include <algorithm>

namespace lodestone::image {

const Channel* Image::find(const std::string& name) const {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const Channel& channel) { return channel.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

Channel& Image::add(const std::string& name) {
  channels.push_back({name, std::vector<float>(pixels()), {}});
  return channels.back();
}

Channel& Image::add_ids(const std::string& name) {
  channels.push_back({name, {}, std::vector<uint32_t>(pixels())});
  return channels.back();
}

}  // namespace lodestone::image
