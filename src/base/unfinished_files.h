// SPDX-License-Identifier: MIT
// Files that are still being written under a temporary name. A program that ends in the middle, in a signal
// handler, takes them with it.
#pragma once

#include <filesystem>

namespace lodestone {

// Remembers a file until it is finished: renamed or removed. Of many at a time the last may be forgotten.
void begin_unfinished(const std::filesystem::path& file);
void end_unfinished(const std::filesystem::path& file);

// Removes all that are remembered. May be called from a signal handler, to end the program after it.
void remove_unfinished_files() noexcept;

}  // namespace lodestone
