// SPDX-License-Identifier: MIT
#include "lodestone/app/output_path.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"

namespace lodestone::app {
namespace fs = std::filesystem;
namespace {

// Whether both name one file, there or not.
bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code failed_a, failed_b;
  const fs::path whole_a = fs::weakly_canonical(a, failed_a), whole_b = fs::weakly_canonical(b, failed_b);
  return !failed_a && !failed_b && whole_a == whole_b;
}

}  // namespace

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

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

bool OutputPattern::writes(const fs::path& file, const FrameRange& frames) const {
  if (!numbered()) return same_file(file, path_);
  // Only the digits that stand where the marks do can be the number of the frame.
  const std::string name = file.filename().string();
  const size_t rest = path_.filename().string().size() - length_;
  if (name.size() <= rest) return false;
  uint32_t frame = 0;
  const char* end = name.data() + first_ + (name.size() - rest);
  const auto [stop, error] = std::from_chars(name.data() + first_, end, frame);
  return error == std::errc() && stop == end && frame >= frames.first && frame <= frames.last &&
         same_file(file, path(frame));
}

void check_writable(const fs::path& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (fs::is_directory(status))
    fail(ExitCode::machine, path.string(), "is a folder; give the name of a file");
  bool made = true;
  std::string reason;
  if (is_device_or_pipe(path)) {  // not opened: that would wait for a reader, or end its reading
    made = ::access(path.c_str(), W_OK) == 0;
    reason = std::strerror(errno);
  } else {
    const fs::path temporary = temporary_beside(link_target(path));
    made = std::ofstream(temporary, std::ios::binary).is_open();
    reason = std::strerror(errno);
    discard_file(temporary);
  }
  if (!made) fail(ExitCode::machine, path.string(), "cannot be written ({}); choose another place", reason);
}

void check_distinct(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
  for (size_t i = 0; i < written.size(); ++i) {
    if (written[i].path.empty()) continue;
    const auto clash = [&](const NamedFile& other) {
      return !other.path.empty() && same_file(written[i].path, other.path);
    };
    for (size_t j = 0; j < i; ++j) {
      if (clash(written[j]))
        fail(ExitCode::usage, written[i].option,
             "`{}` is what {} writes already; give each a file of its own", written[i].path.string(),
             written[j].option);
    }
    for (const NamedFile& other : read) {
      if (clash(other))
        fail(ExitCode::usage, written[i].option, "`{}` is {}, which would be overwritten; name another file",
             written[i].path.string(), other.option);
    }
  }
}

}  // namespace lodestone::app
