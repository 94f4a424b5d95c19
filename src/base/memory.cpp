// SPDX-License-Identifier: MIT
#include "lodestone/base/memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>

#include "lodestone/base/error.h"

namespace lodestone {
namespace {

std::optional<uint64_t> read_number(const std::filesystem::path& file) {
  std::ifstream in(file);
  uint64_t value = 0;
  if (in >> value) return value;
  return {};  // absent, or "max"
}

// The number behind the word `name`.
std::optional<uint64_t> read_entry(const std::filesystem::path& file, const std::string& name) {
  std::ifstream in(file);
  std::string word;
  uint64_t value = 0;
  while (in >> word) {
    if (word == name && in >> value) return value;
  }
  return {};
}

}  // namespace

uint64_t available_memory(const std::filesystem::path& proc, const std::filesystem::path& cgroup) {
  uint64_t bytes = std::numeric_limits<uint64_t>::max();
  if (const auto kibibytes = read_entry(proc / "meminfo", "MemAvailable:")) bytes = *kibibytes << 10;
  const auto limit = read_number(cgroup / "memory.max"), used = read_number(cgroup / "memory.current");
  if (!limit || !used) return bytes;
  // Files that were read count as used until somebody needs the room.
  const uint64_t cached = read_entry(cgroup / "memory.stat", "inactive_file").value_or(0);
  const uint64_t held = *used - std::min(*used, cached);
  return std::min(bytes, *limit - std::min(*limit, held));
}

void require_memory(uint64_t bytes, const std::string& owner) {
  // Reading files for what is small would cost more than it saves.
  if (bytes < uint64_t(64) << 20) return;
  const uint64_t available = available_memory();
  if (bytes <= available) return;
  fail(ExitCode::machine, "memory",
       "{} needs {} MiB, of which {} MiB are to be had: choose a smaller scene, resolution or picture", owner,
       bytes >> 20, available >> 20);
}

}  // namespace lodestone
