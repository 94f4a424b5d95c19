// SPDX-License-Identifier: MIT
// How much memory there is to be had. Linux grants more than it has and ends the process when that is used:
// what may be large asks first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace lodestone {

// Bytes that this process can still use, by the kernel's own estimate and the limit of its control group; the
// largest number where neither tells. `proc` and `cgroup`: where those file systems are mounted.
uint64_t available_memory(const std::filesystem::path& proc = "/proc",
                          const std::filesystem::path& cgroup = "/sys/fs/cgroup");

// Throws Error(machine) naming `owner` where `bytes` more are not to be had.
void require_memory(uint64_t bytes, const std::string& owner);

}  // namespace lodestone
