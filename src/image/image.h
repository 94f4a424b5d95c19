// SPDX-License-Identifier: MIT
// Rendered images in memory and on disk.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lodestone::image {

// The most samples (width x height x channels) an image that is read may claim to have; more is taken for
// hostile.
inline constexpr uint64_t max_samples = uint64_t(1) << 28;

// One named plane, row by row from the top. Exactly one of the two arrays holds width x height samples.
struct Channel {
  std::string name;  // "R", "depth.Z", "id.mesh": the EXR channel name
  std::vector<float> values;
  std::vector<uint32_t> ids;  // unsigned channels (id.mesh, id.triangle)
};

// What EXR calls the standard attributes worldToCamera and worldToNDC: for row vectors (p' = p M), row by
// row. The camera looks along +Z, +X right, +Y up; NDC has (0, 0) in the upper left corner of the picture and
// (1, 1) in the lower right one, after division by w.
struct CameraMatrices {
  std::array<float, 16> world_to_camera{}, world_to_ndc{};
};

struct Image {
  uint32_t width = 0, height = 0;
  std::vector<Channel> channels;  // names differ
  // Name to text. EXR reserves the names of its own header ("channels", "compression", ...) and takes up to
  // 255 bytes of name, PNG up to 79; neither text nor name holds a zero byte.
  std::map<std::string, std::string> metadata;
  std::optional<CameraMatrices> camera;  // kept by EXR only
  // Whether R G B are linear light (an EXR) rather than encoded for a display (a PNG). Nothing is converted
  // by it; the comparison needs to know.
  bool linear = true;

  uint64_t pixels() const { return uint64_t(width) * height; }
  const Channel* find(const std::string& name) const;  // nullptr where there is none
  // Appends a channel of width x height zeros; the reference holds until the next channel is added.
  Channel& add(const std::string& name);
  Channel& add_ids(const std::string& name);
};

// EXR: every channel, float or uint, in the native format, ZIP; metadata as string attributes, the camera as
// matrices. PNG: R G B (A where there is one), or a lone Y as grey, as they are (already tone-mapped and
// encoded; alpha is neither multiplied in nor divided out), clamped to 0..1, NaN as 0, 8 bits by
// floor(255 x + 0.5); metadata as tEXt.
// Both are byte-identical for equal input (no time stamps), and appear whole or not at all. Throws
// Error(usage) for another extension, for a PNG without R G B, and for metadata whose name is reserved;
// Error(machine) where it cannot be written; std::invalid_argument where a channel has not width x height
// samples or two channels have one name.
void write(const std::filesystem::path& path, const Image& image);

// Any image that OpenImageIO reads, the first one where the file holds several: floats as they are, 8- and
// 16-bit integers as x / 255 and x / 65535 (not linear: Image::linear is false), 32-bit unsigned channels as
// ids; alpha as it is. Channels are named as in the file (grey: "Y"), in OpenImageIO's order. String
// attributes become metadata, the two standard matrices the camera. Throws Error(bad_input) where it is
// missing, truncated or no image, or has more than max_samples samples.
Image read(const std::filesystem::path& path);

// R G B for a PNG: encoded by the sRGB curve where they are linear, clamped to 0..1, NaN as 0. Of an image
// without R G B its first channel as grey, from the smallest to the largest finite sample; ids so too.
Image for_display(const Image& image);

// A picture of float channels, its sides divided by the least whole number (rounded up) that makes none
// longer than `longest`: the means of the pixels. Without metadata.
Image shrunk(const Image& image, uint32_t longest);

// Tiles of equal size in rows of `columns`, their R G B only, a label above each: printable ASCII ('?' stands
// for the rest), in as large letters as let all of it fit, cut where the smallest do not. Encoded as the
// tiles are. Throws std::invalid_argument where there are no tiles, not as many labels, sizes differ or a
// tile has no R G B.
Image contact_sheet(const std::vector<Image>& tiles, const std::vector<std::string>& labels,
                    uint32_t columns);

}  // namespace lodestone::image
