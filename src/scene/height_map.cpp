// SPDX-License-Identifier: MIT
// Height maps: grey images whose values, 0 to 1 for integers, are heights.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/scene/decode_image.h"
#include "lodestone/scene/encoded_image.h"
#include "lodestone/scene/exr_outline.h"
#include "lodestone/scene/height_field.h"
#include "lodestone/scene/load.h"
#include "lodestone/scene/single_mesh.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

constexpr uint64_t max_file_bytes = uint64_t(1) << 31;
// Deflate, which packs best of what is in use, makes at most 1032 bytes of one. The allowance is for small
// images of a single value in formats that store those in almost nothing.
constexpr uint64_t max_expansion = 1032, expansion_allowance = uint64_t(1) << 20;

struct Samples {
  uint32_t width = 0, height = 0;
  std::vector<float> values;  // row by row from the top
};

// OpenImageIO's name for the format that the file opens with. It would try all its readers on an unknown one.
std::string format_of(std::string_view bytes, const std::string& file) {
  using namespace std::string_view_literals;
  if (bytes.empty()) fail_input(file, "is empty; expected an image");
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return "png";
  if (bytes.starts_with("\x76\x2f\x31\x01"sv)) return "openexr";
  for (const std::string_view magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}) {
    if (bytes.starts_with(magic)) return "tiff";
  }
  fail_input(file,
             "byte 0: is neither a PNG, an OpenEXR nor a TIFF image; convert the height map to one of them");
}

std::string reason(const std::string& error) {
  std::string line = error.substr(0, error.find('\n'));
  return line.empty() ? "the data are broken" : line;
}

void check_size(uint64_t width, uint64_t height, uint64_t texel_bytes, uint64_t file_bytes,
                const std::string& file) {
  if (width < 2 || height < 2) {
    fail_input(file, "has {} x {} samples; a height map is an image of at least 2 x 2", width, height);
  }
  if (width > max_image_texels || height > max_image_texels / width) {
    fail_input(file, "has {} x {} samples, more than {} in all; reduce it or cut it into several", width,
               height, max_image_texels);
  }
  if (width * height >
      (expansion_allowance + max_expansion * file_bytes) / std::max<uint64_t>(texel_bytes, 1)) {
    fail_input(file, "claims {} x {} samples, more than its {} bytes can hold; convert it again", width,
               height, file_bytes);
  }
}

// Where the channels that are not alpha stand: one, or red, green and blue.
std::vector<size_t> value_channels(const OIIO::ImageSpec& spec, const std::string& file) {
  std::vector<size_t> channels;
  for (int c = 0; c < spec.nchannels; ++c) {
    if (c != spec.alpha_channel) channels.push_back(size_t(c));
  }
  if (channels.size() != 1 && channels.size() != 3) {
    fail_input(file, "has {} channels; convert the height map to a grey image", spec.nchannels);
  }
  return channels;
}

// The values of the channel, of which there may be three equal ones.
template <class Stored>
void extract(OIIO::ImageInput& input, OIIO::TypeDesc type, float full, const std::string& file,
             Samples& samples) {
  const OIIO::ImageSpec& spec = input.spec();
  const std::vector<size_t> channels = value_channels(spec, file);
  const auto stride = static_cast<size_t>(spec.nchannels);
  const size_t count = size_t(samples.width) * samples.height;
  std::vector<Stored> stored(count * stride);
  if (!input.read_image(0, 0, 0, spec.nchannels, type, stored.data())) {
    fail_input(file, "cannot be decoded ({}); get the whole file or convert it again",
               reason(input.geterror()));
  }
  samples.values.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const Stored* texel = &stored[i * stride];
    const float value = static_cast<float>(texel[channels[0]]) / full;
    if (!std::isfinite(value)) {
      fail_input(file, "column {}, row {}: the height is not a finite number; fill the holes of the map",
                 i % samples.width, i / samples.width);
    }
    for (const size_t c : channels) {
      if (texel[c] != texel[channels[0]]) {
        fail_input(file, "column {}, row {}: red, green and blue differ; a height map is grey, convert it",
                   i % samples.width, i / samples.width);
      }
    }
    samples.values[i] = value;
  }
}

Samples read_samples(const std::string& file) {
  std::string format;
  uint64_t file_bytes = 0;
  {
    const std::vector<std::byte> contents = read_file(file, max_file_bytes);
    format = format_of(as_text(contents), file);
    file_bytes = contents.size();
    check_encoded_image(contents, file);
    if (format == "openexr") {
      const ExrOutline outline = read_exr_outline(file, as_text(contents));
      check_size(outline.width, outline.height, outline.texel_bytes, file_bytes, file);
    }
  }
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // heights are not multiplied by alpha
  OIIO::ImageSpec spec;
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
  if (!input) fail(ExitCode::machine, file, "OpenImageIO was built without {}; install one with it", format);
  if (!input->open(file, spec, config)) {
    fail_input(file, "cannot be decoded ({}); get the whole file or convert it again",
               reason(input->geterror()));
  }
  if (spec.width < 0 || spec.height < 0 || spec.depth > 1 || spec.deep) {
    fail_input(file, "is no flat image; a height map has one sample a column and row");
  }
  check_size(uint64_t(spec.width), uint64_t(spec.height), spec.pixel_bytes(true), file_bytes, file);
  Samples samples;
  samples.width = static_cast<uint32_t>(spec.width);
  samples.height = static_cast<uint32_t>(spec.height);
  if (spec.format == OIIO::TypeDesc::UINT8) {
    extract<uint8_t>(*input, OIIO::TypeDesc::UINT8, 255, file, samples);
  } else if (spec.format == OIIO::TypeDesc::UINT16) {
    extract<uint16_t>(*input, OIIO::TypeDesc::UINT16, 65535, file, samples);
  } else {
    extract<float>(*input, OIIO::TypeDesc::FLOAT, 1, file, samples);
  }
  return samples;
}

}  // namespace

Scene load_height_map(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string file = path.string();
  if (!std::isfinite(options.height_scale) || options.height_scale < 0) {
    fail(ExitCode::usage, "--height", "{} is no scale for a height map; give a number above 0",
         options.height_scale);
  }
  Samples samples = read_samples(file);
  const auto larger_side = static_cast<float>(std::max(samples.width, samples.height) - 1);
  const float scale = options.height_scale > 0 ? options.height_scale : 0.25f * larger_side;
  for (float& value : samples.values) {
    value *= scale;
    if (!std::isfinite(value))
      fail_input(file, "its heights times {} are out of range; give a smaller --height", scale);
  }
  Mesh mesh = make_height_field(samples.width, samples.height, samples.values);
  return single_mesh_scene(path, std::move(mesh));
}

}  // namespace lodestone::scene
