// SPDX-License-Identifier: MIT
#include "lodestone/base/log.h"

#include <atomic>
#include <cstdio>
#include <mutex>
#include <set>

#include "lodestone/base/plain_line.h"

namespace lodestone::log {
namespace {
std::atomic<Level> current{Level::normal};
}

void set_level(Level level) {
  current = level;
}
Level level() {
  return current;
}

void warn(const std::string& message) {
  if (current != Level::quiet) fmt::print(stderr, "lodestone: warning: {}\n", plain_line(message));
}

void warn_once(const std::string& key, const std::string& message) {
  static std::mutex mutex;
  static std::set<std::string> seen;
  {
    const std::lock_guard lock(mutex);
    if (!seen.insert(key).second) return;
  }
  warn(message);
}

void note(const std::string& message) {
  if (current == Level::verbose) fmt::print(stderr, "lodestone: {}\n", plain_line(message));
}

}  // namespace lodestone::log
