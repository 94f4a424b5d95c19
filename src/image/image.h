// SPDX-License-Identifier: MIT
// Rendered images in memory and on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lodestone::image {

// One named plane, row by row from the top. Exactly one of the two arrays holds width x height samples.
struct Channel {
  std::string name;  // "R", "depth.Z", "id.mesh": the EXR channel name
  std::vector<float> values;
  std::vector<uint32_t> ids;  // unsigned channels (id.mesh, id.triangle)
};

struct Image {
  uint32_t width = 0, height = 0;
  std::vector<Channel> channels;
  std::map<std::string, std::string> metadata;

  const Channel* find(const std::string& name) const;
  Channel& add(const std::string& name);  // float, zero-filled
  Channel& add_ids(const std::string& name);
};

// EXR: every channel, float or uint, in the native format, ZIP; metadata as string attributes. Byte-identical
// for equal input. PNG: R G B (A where there is one) as they are (already tone-mapped and encoded), clamped to 0..1,
// 8 bits by floor(255 x + 0.5); metadata as text. The file appears whole or not at all.
// Throws Error(usage) for another extension, Error(machine) where it cannot be written.
void write(const std::filesystem::path& path, const Image& image);

// Any image that OpenImageIO reads: floats (uint channels of an EXR stay uint), 8- and 16-bit integers as 0..1.
// Throws Error(bad_input).
Image read(const std::filesystem::path& path);

// Tiles of equal size in rows of `columns`, RGB(A) only, a label above each (drawn with OpenImageIO).
Image contact_sheet(const std::vector<Image>& tiles, const std::vector<std::string>& labels, uint32_t columns);

}  // namespace lodestone::image
