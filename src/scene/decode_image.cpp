// SPDX-License-Identifier: MIT
#include "lodestone/scene/decode_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/scene/encoded_image.h"

namespace lodestone::scene {
namespace {

// No texture format packs more than about a thousand bytes of texels into one (deflate: 1032), but for images
// of a single colour, which the allowance covers.
constexpr uint64_t max_expansion = 1100;
constexpr uint64_t expansion_allowance = uint64_t(1) << 26;
constexpr uint64_t max_file_bytes = uint64_t(1) << 31;

bool starts_with(std::span<const std::byte> bytes, size_t offset, std::string_view magic) {
  return bytes.size() >= offset + magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset),
                    [](char expected, std::byte actual) { return std::byte(expected) == actual; });
}

// The file extension of the format that the bytes open with; empty for another.
std::string format_of(std::span<const std::byte> bytes) {
  if (starts_with(bytes, 0, "\x89PNG\r\n\x1a\n")) return "png";
  if (starts_with(bytes, 0, "\xff\xd8\xff")) return "jpg";
  if (starts_with(bytes, 0, "RIFF") && starts_with(bytes, 8, "WEBP")) return "webp";
  return {};
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.empty() ? "the data are broken" : text;
}

void check_size(const OIIO::ImageSpec& spec, uint64_t file_bytes, const std::string& subject) {
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1) {
    fail_input(subject, "is not a two-dimensional image; re-export it as PNG or JPEG");
  }
  const uint64_t width = uint64_t(spec.width), height = uint64_t(spec.height);
  if (width > max_image_side || height > max_image_side || width * height > max_image_texels) {
    fail_input(subject, "has {} x {} texels, more than {} a side or {} in all; reduce it", width, height,
               max_image_side, max_image_texels);
  }
  if (width * height * spec.pixel_bytes(true) > expansion_allowance + max_expansion * file_bytes) {
    fail_input(subject, "claims {} x {} texels, more than its {} bytes can hold; re-export it", width, height,
               file_bytes);
  }
}

// Spreads `channels` interleaved samples a texel to R G B A.
std::vector<uint8_t> to_rgba(const std::vector<uint8_t>& samples, const OIIO::ImageSpec& spec) {
  const size_t channels = size_t(spec.nchannels);
  const size_t texels = samples.size() / channels;
  const bool grey = channels < 3;
  const bool has_alpha = spec.alpha_channel >= 0 && spec.alpha_channel < spec.nchannels;
  std::vector<uint8_t> rgba(texels * 4);
  for (size_t i = 0; i < texels; ++i) {
    const uint8_t* from = &samples[i * channels];
    uint8_t* to = &rgba[i * 4];
    for (size_t c = 0; c < 3; ++c) to[c] = from[grey ? 0 : c];
    to[3] = has_alpha ? from[spec.alpha_channel] : uint8_t(255);
  }
  return rgba;
}

Image read_all(OIIO::ImageInput& input, uint64_t file_bytes, const std::string& subject) {
  const OIIO::ImageSpec spec = input.spec();
  check_size(spec, file_bytes, subject);
  Image image;
  image.width = uint32_t(spec.width);
  image.height = uint32_t(spec.height);
  std::vector<uint8_t> samples(size_t(image.width) * image.height * size_t(spec.nchannels));
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, samples.data())) {
    fail_input(subject, "cannot be decoded ({}); re-export it", one_line(input.geterror()));
  }
  image.rgba = spec.nchannels == 4 && spec.alpha_channel == 3 ? std::move(samples) : to_rgba(samples, spec);
  return image;
}

OIIO::ImageSpec unassociated_alpha() {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  return config;
}

}  // namespace

Image decode_image(std::span<const std::byte> bytes, const std::string& subject) {
  const std::string format = format_of(bytes);
  if (format.empty()) fail_input(subject, "is neither PNG, JPEG nor WebP; re-export it as one of them");
  check_encoded_image(bytes, subject);
  OIIO::Filesystem::IOMemReader reader(const_cast<std::byte*>(bytes.data()), bytes.size());
  OIIO::ImageSpec config = unassociated_alpha();
  void* proxy = static_cast<OIIO::Filesystem::IOProxy*>(&reader);
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR,
                   &proxy);  // open() drops its own argument beside a config
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open("memory." + format, &config);
  if (!input) fail_input(subject, "cannot be decoded ({}); re-export it", one_line(OIIO::geterror()));
  return read_all(*input, bytes.size(), subject);
}

Image decode_image_file(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path, max_file_bytes);
  if (!format_of(bytes).empty()) return decode_image(bytes, path.string());
  const OIIO::ImageSpec config = unassociated_alpha();
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string(), &config);
  if (!input) {
    fail_input(path.string(), "cannot be decoded as an image ({}); re-export it as PNG or JPEG",
               one_line(OIIO::geterror()));
  }
  return read_all(*input, bytes.size(), path.string());
}

}  // namespace lodestone::scene
