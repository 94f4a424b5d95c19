// SPDX-License-Identifier: MIT
#include "lodestone/scene/scene.h"

#include <algorithm>

namespace lodestone::scene {

float Animation::duration() const {
  float last = 0;
  for (const Channel& channel : channels) {
    if (!channel.times.empty()) last = std::max(last, channel.times.back());
  }
  return last;
}

}  // namespace lodestone::scene
