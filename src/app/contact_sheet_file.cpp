// SPDX-License-Identifier: MIT
#include "lodestone/app/contact_sheet_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/app/output_path.h"
#include "lodestone/base/error.h"

namespace lodestone::app {
namespace {

constexpr uint32_t most_tiles = 24;
constexpr uint32_t largest_tile = 512;  // pixels of a side: a sheet of large pictures must still fit memory

}  // namespace

ContactSheetFile::ContactSheetFile(std::string path, uint32_t frames)
    : path_(std::move(path)), frames_(frames) {
  if (!path_.empty() && lower_extension(path_) != ".png")
    fail(ExitCode::usage, "--contact-sheet", "`{}` is no PNG; name a .png", path_);
}

void ContactSheetFile::add(uint32_t index, uint32_t frame, const image::Image& display) {
  if (path_.empty()) return;
  // Frame i is kept where i * tiles / frames steps to the next tile.
  const uint64_t tiles = std::min(frames_, most_tiles);
  if (index != 0 && index * tiles / frames_ == (index - 1) * tiles / frames_) return;
  tiles_.push_back(image::shrunk(display, largest_tile));
  labels_.push_back(fmt::format("{}", frame));
}

void ContactSheetFile::write() const {
  if (path_.empty() || tiles_.empty()) return;
  const auto columns = static_cast<uint32_t>(std::ceil(std::sqrt(1.5 * static_cast<double>(tiles_.size()))));
  image::write(path_, image::contact_sheet(tiles_, labels_, columns));
}

}  // namespace lodestone::app
