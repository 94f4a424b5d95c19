// SPDX-License-Identifier: MIT
// Whole files in and out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace lodestone {

// The bytes of a regular file. Throws Error(bad_input) where it cannot be read, is not a regular file, or is
// larger than `limit` bytes.
std::vector<std::byte> read_file(const std::filesystem::path& path, uint64_t limit = uint64_t(1) << 34);

// A place beside `path` to write to before `commit_file` renames it: output appears whole or not at all.
// Missing folders are made. Keeps the extension (image writers choose a format by it). An interrupt removes
// what is there (unfinished_files.h) until it is committed or discarded.
std::filesystem::path temporary_beside(const std::filesystem::path& path);
// Renames `temporary` to `path`. Throws Error(machine).
void commit_file(const std::filesystem::path& temporary, const std::filesystem::path& path);

// Removes `temporary`, if it is there.
void discard_file(const std::filesystem::path& temporary);

// Whether something is there that is neither a file nor a folder: renaming would put a file in its place.
bool is_device_or_pipe(const std::filesystem::path& path);
// What a symbolic link leads to in the end, there or not; any other path as it is. Throws Error(machine)
// where links lead round in a ring.
std::filesystem::path link_target(const std::filesystem::path& path);

// Writes beside and renames; a link stays and what it leads to is written; a device or a pipe is written into
// directly. Throws Error(machine) where the disk is full or the place cannot be written.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace lodestone
