// SPDX-License-Identifier: MIT
#include "lodestone/base/unfinished_files.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <mutex>
#include <string>

namespace lodestone {
namespace {

// In memory that no allocation moves and behind a flag that needs no lock, because a signal handler reads it.
struct Slot {
  std::atomic<bool> used{false};
  char path[PATH_MAX];
};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

constexpr size_t most_files = 16;  // threads that write files at the same time
std::array<Slot, most_files> slots;
std::mutex mutex;  // of those who fill and free slots

}  // namespace

void begin_unfinished(const std::filesystem::path& file) {
  const std::string& name = file.native();
  if (name.size() >= PATH_MAX) return;  // it cannot be opened either
  const std::lock_guard lock(mutex);
  for (Slot& slot : slots) {
    if (slot.used) continue;
    slot.path[name.copy(slot.path, name.size())] = '\0';
    slot.used = true;
    return;
  }
}

void end_unfinished(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex);
  for (Slot& slot : slots)
    if (slot.used && file.native() == slot.path) slot.used = false;
}

void remove_unfinished_files() noexcept {
  for (const Slot& slot : slots)
    if (slot.used) ::unlink(slot.path);
}

}  // namespace lodestone
