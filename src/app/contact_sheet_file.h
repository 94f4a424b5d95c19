// SPDX-License-Identifier: MIT
// A sequence at a glance: `render --contact-sheet`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/image/image.h"

namespace lodestone::app {

// Keeps at most 24 frames of the sequence, evenly spread, and writes them as one PNG with their numbers.
// Frames of more than 512 pixels a side are shrunk by a whole number.
class ContactSheetFile {
 public:
  // `path` empty: does nothing. Throws Error(usage) unless it names a .png.
  ContactSheetFile(std::string path, uint32_t frames);
  void add(uint32_t index, uint32_t frame,
           const image::Image& display);  // index: 0 for the first frame rendered
  void write() const;                     // nothing where no frame was added

 private:
  std::string path_;
  uint32_t frames_;
  std::vector<image::Image> tiles_;
  std::vector<std::string> labels_;
};

}  // namespace lodestone::app
