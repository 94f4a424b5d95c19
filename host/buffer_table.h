// SPDX-License-Identifier: MIT
// The buffers of a back end by their identifiers.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lodestone/host/device_array.h"
#include "lodestone/render/backend.h"

namespace lodestone::host {

struct BufferEntry {
  render::BufferDesc desc;
  std::unique_ptr<DeviceArray> array;
  uint64_t last_batch = 0;  // the youngest batch that uses it

  uint64_t bytes() const { return desc.elements * desc.element_bytes; }  // what its user sees
};

// Identifiers start at 1 and are used again.
class BufferTable {
 public:
  render::BufferId add(BufferEntry entry);
  BufferEntry take(render::BufferId id);  // removes it
  BufferEntry& get(render::BufferId id);
  const BufferEntry& get(render::BufferId id) const;

 private:
  void check_id(render::BufferId id) const;

  std::vector<BufferEntry> entries_;
  std::vector<render::BufferId> free_;
};

}  // namespace lodestone::host
