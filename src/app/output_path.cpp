// SPDX-License-Identifier: MIT
#include "lodestone/app/output_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"

namespace lodestone::app {
namespace fs = std::filesystem;
namespace {

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

}  // namespace

OutputPattern::OutputPattern(const std::string& option, const std::string& path) : path_(path) {
  const std::string extension = lower_extension(path_);
  if (extension != ".exr" && extension != ".png")
    fail(ExitCode::usage, option, "`{}` ends in neither .exr nor .png; choose one of them", path);
  const std::string name = path_.filename().string();
  const size_t first = name.find('#');
  if (first == std::string::npos) return;
  const size_t end = std::min(name.find_first_not_of('#', first), name.size());
  if (name.find('#', end) != std::string::npos)
    fail(ExitCode::usage, option, "`{}` has several runs of #; keep the one that the frame number goes into",
         path);
  first_ = first;
  length_ = end - first;
}

bool OutputPattern::is_png() const {
  return lower_extension(path_) == ".png";
}

fs::path OutputPattern::path(uint32_t frame) const {
  if (!numbered()) return path_;
  std::string name = path_.filename().string();
  name.replace(first_, length_, fmt::format("{:0{}}", frame, length_));
  fs::path numbered_path = path_;
  return numbered_path.replace_filename(name);
}

void check_writable(const fs::path& path) {
  std::error_code failed;
  if (fs::is_directory(path, failed))
    fail(ExitCode::machine, path.string(), "is a folder; give the name of a file");
  const fs::path temporary = temporary_beside(path);
  const bool made = std::ofstream(temporary, std::ios::binary).is_open();
  const std::string reason = std::strerror(errno);
  fs::remove(temporary, failed);
  if (!made) fail(ExitCode::machine, path.string(), "cannot be written ({}); choose another place", reason);
}

}  // namespace lodestone::app
