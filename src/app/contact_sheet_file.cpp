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

// The mean of every `factor` x `factor` pixels; what is left over at the right and the bottom too.
image::Image shrunk(const image::Image& picture, uint32_t factor) {
  image::Image small;
  small.width = (picture.width + factor - 1) / factor;
  small.height = (picture.height + factor - 1) / factor;
  small.linear = picture.linear;
  for (const image::Channel& channel : picture.channels) {
    std::vector<float>& values = small.add(channel.name).values;
    for (uint32_t y = 0; y < small.height; ++y) {
      for (uint32_t x = 0; x < small.width; ++x) {
        const uint32_t right = std::min((x + 1) * factor, picture.width);
        const uint32_t bottom = std::min((y + 1) * factor, picture.height);
        float sum = 0;
        for (uint32_t row = y * factor; row < bottom; ++row) {
          for (uint32_t column = x * factor; column < right; ++column)
            sum += channel.values[size_t(row) * picture.width + column];
        }
        values[size_t(y) * small.width + x] =
            sum / static_cast<float>((right - x * factor) * (bottom - y * factor));
      }
    }
  }
  return small;
}

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
  const uint32_t side = std::max(display.width, display.height);
  const uint32_t factor = (side + largest_tile - 1) / largest_tile;
  tiles_.push_back(factor == 1 ? display : shrunk(display, factor));
  labels_.push_back(fmt::format("{}", frame));
}

void ContactSheetFile::write() const {
  if (path_.empty() || tiles_.empty()) return;
  const auto columns = static_cast<uint32_t>(std::ceil(std::sqrt(1.5 * static_cast<double>(tiles_.size()))));
  image::write(path_, image::contact_sheet(tiles_, labels_, columns));
}

}  // namespace lodestone::app
