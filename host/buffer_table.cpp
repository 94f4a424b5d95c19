// SPDX-License-Identifier: MIT
#include "lodestone/host/buffer_table.h"

#include <utility>

#include "lodestone/host/check.h"

namespace lodestone::host {

render::BufferId BufferTable::add(BufferEntry entry) {
  if (free_.empty()) {
    entries_.push_back(std::move(entry));
    return render::BufferId(entries_.size());
  }
  const render::BufferId id = free_.back();
  free_.pop_back();
  entries_[id - 1] = std::move(entry);
  return id;
}

BufferEntry BufferTable::take(render::BufferId id) {
  check_id(id);
  free_.push_back(id);
  return std::exchange(entries_[id - 1], {});
}

BufferEntry& BufferTable::get(render::BufferId id) {
  check_id(id);
  return entries_[id - 1];
}

const BufferEntry& BufferTable::get(render::BufferId id) const {
  check_id(id);
  return entries_[id - 1];
}

void BufferTable::check_id(render::BufferId id) const {
  require(id >= 1 && id <= entries_.size() && entries_[id - 1].array != nullptr, "there is no buffer {}", id);
}

}  // namespace lodestone::host
