// SPDX-License-Identifier: MIT
#include "lodestone/base/file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "lodestone/base/error.h"
#include "lodestone/base/unfinished_files.h"

namespace lodestone {
namespace fs = std::filesystem;
namespace {

constexpr int most_links = 40;  // as Linux follows

}  // namespace

std::vector<std::byte> read_file(const fs::path& path, uint64_t limit) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (!fs::exists(status)) fail_input(path.string(), "no such file; check the path");
  if (!fs::is_regular_file(status)) fail_input(path.string(), "is not a regular file");
  const uint64_t size = fs::file_size(path, failed);
  if (failed) fail_input(path.string(), "cannot be read: {}", failed.message());
  if (size > limit) fail_input(path.string(), "has {} bytes, more than the {} that are read", size, limit);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail_input(path.string(), "cannot be opened: {}", std::strerror(errno));
  std::vector<std::byte> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<uint64_t>(stream.gcount()) != size) fail_input(path.string(), "cannot be read to its end");
  return bytes;
}

bool is_device_or_pipe(const fs::path& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

fs::path link_target(const fs::path& path) {
  fs::path target = path;
  std::error_code failed;
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, failed)); ++links) {
    if (links == most_links)
      fail(ExitCode::machine, path.string(), "is a ring of links; choose another place");
    target = target.parent_path() / fs::read_symlink(target, failed);
  }
  return target;
}

fs::path temporary_beside(const fs::path& path) {
  static std::atomic<uint32_t> serial{0};
  if (path.has_parent_path()) {
    std::error_code failed;
    fs::create_directories(path.parent_path(), failed);
    if (failed) {
      fail(ExitCode::machine, path.string(), "its folder cannot be made ({}); choose another place",
           failed.message());
    }
  }
  fs::path temporary = path;
  temporary.replace_filename(
      fmt::format(".{}.{}.{}{}", path.stem().string(), ::getpid(), serial++, path.extension().string()));
  begin_unfinished(temporary);
  return temporary;
}

void commit_file(const fs::path& temporary, const fs::path& path) {
  std::error_code failed;
  fs::rename(temporary, path, failed);
  if (!failed) {
    end_unfinished(temporary);
    return;
  }
  const std::string reason = failed.message();
  discard_file(temporary);
  fail(ExitCode::machine, path.string(), "cannot be written: {}", reason);
}

void discard_file(const fs::path& temporary) {
  std::error_code ignored;
  fs::remove(temporary, ignored);
  end_unfinished(temporary);
}

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
  const bool beside = !is_device_or_pipe(path);
  const fs::path target = beside ? link_target(path) : path;
  const fs::path written = beside ? temporary_beside(target) : target;
  std::ofstream stream(written, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) {
    const std::string reason = std::strerror(errno);
    if (beside) discard_file(written);
    fail(ExitCode::machine, path.string(), "cannot be written ({}); free some room or choose another place",
         reason);
  }
  if (beside) commit_file(written, target);
}

void write_file(const fs::path& path, const std::string& text) {
  write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace lodestone
