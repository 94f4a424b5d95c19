// SPDX-License-Identifier: MIT
// When a pass must wait for those before it. Knows no Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>

namespace lodestone::host {

struct BufferUse {
  uint32_t buffer = 0;
  bool reads = false, writes = false;
};

// Remembers what commands did to buffers since the last barrier; a barrier orders everything before it.
class HazardTracker {
 public:
  // Enters the uses of the next command. True: it needs a barrier before it, because it reads or writes what
  // was written since the last one, or writes what was read.
  bool enter(std::span<const BufferUse> uses);
  // Everything before is ordered: a barrier was made for another reason, or the device was waited for.
  void clear() { pending_.clear(); }

 private:
  struct Pending {
    bool read = false, written = false;
  };
  std::unordered_map<uint32_t, Pending> pending_;
};

}  // namespace lodestone::host
