// SPDX-License-Identifier: MIT
// Where pictures go: one file, or a sequence of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lodestone/app/parse_values.h"

namespace lodestone::app {

// The extension of a path in small letters, with its dot.
std::string lower_extension(const std::filesystem::path& path);

// A path whose file name may hold one run of `#`, which stands for the frame number, padded with zeros to the
// length of the run (a longer number keeps all its digits).
class OutputPattern {
 public:
  // Throws Error(usage), naming `option`, unless the extension is .exr or .png, and where there are several
  // runs.
  OutputPattern(const std::string& option, const std::string& path);

  bool numbered() const { return length_ > 0; }
  bool is_png() const;
  std::filesystem::path path(uint32_t frame) const;
  // Whether one of these frames goes to this very file.
  bool writes(const std::filesystem::path& file, const FrameRange& frames) const;

 private:
  std::filesystem::path path_;
  size_t first_ = 0, length_ = 0;  // the run within the file name
};

// Throws Error(machine) unless a file can be made at `path`; makes missing folders. Leaves a file that is
// there as it is, and opens no device or pipe. Called before a long computation, so that it is not done in
// vain.
void check_writable(const std::filesystem::path& path);

// A file of the command line, and the option that names it.
struct NamedFile {
  std::string option;
  std::filesystem::path path;  // empty: not given
};

// Throws Error(usage) where a file is to be written twice, or is one that the command reads.
void check_distinct(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

}  // namespace lodestone::app
