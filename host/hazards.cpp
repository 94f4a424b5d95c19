// SPDX-License-Identifier: MIT
#include "lodestone/host/hazards.h"

#include <algorithm>

namespace lodestone::host {

bool HazardTracker::enter(std::span<const BufferUse> uses) {
  const bool conflict = std::any_of(uses.begin(), uses.end(), [&](const BufferUse& use) {
    const auto found = pending_.find(use.buffer);
    if (found == pending_.end()) return false;
    return found->second.written || (use.writes && found->second.read);
  });
  if (conflict) pending_.clear();
  for (const BufferUse& use : uses) {
    Pending& pending = pending_[use.buffer];
    pending.read |= use.reads;
    pending.written |= use.writes;
  }
  return conflict;
}

}  // namespace lodestone::host
