// SPDX-License-Identifier: MIT
// Images to disk. Files are encoded in memory and then written whole, so that a full disk is noticed by one
// place.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/image/image.h"

namespace lodestone::image {
namespace {

constexpr uint32_t strip_rows = 64;  // a multiple of the 16 rows that a ZIP block of an EXR holds

// Header attributes of EXR that a string of the same name would spoil.
constexpr std::array<std::string_view, 17> reserved_names = {"channels",
                                                             "compression",
                                                             "dataWindow",
                                                             "displayWindow",
                                                             "lineOrder",
                                                             "name",
                                                             "type",
                                                             "version",
                                                             "chunkCount",
                                                             "view",
                                                             "tiles",
                                                             "preview",
                                                             "envmap",
                                                             "multiView",
                                                             "pixelAspectRatio",
                                                             "screenWindowCenter",
                                                             "screenWindowWidth"};

void check_channels(const Image& image) {
  if (image.pixels() == 0 || image.channels.empty()) throw std::invalid_argument("an image without samples");
  std::set<std::string> names;
  for (const Channel& channel : image.channels) {
    if (!names.insert(channel.name).second) throw std::invalid_argument("two channels named " + channel.name);
    const bool is_float = channel.values.size() == image.pixels() && channel.ids.empty();
    const bool is_id = channel.ids.size() == image.pixels() && channel.values.empty();
    if (!is_float && !is_id) throw std::invalid_argument("channel " + channel.name + " has another size");
  }
}

void set_metadata(OIIO::ImageSpec& spec, const std::filesystem::path& path, const Image& image) {
  // OpenImageIO stamps an EXR with the time of day unless DateTime is set.
  spec.attribute("DateTime", "");
  for (const auto& [name, text] : image.metadata) {
    const bool reserved =
        std::find(reserved_names.begin(), reserved_names.end(), name) != reserved_names.end();
    if (reserved || name.empty() || name.size() > 255)
      fail(ExitCode::usage, path.string(), "cannot hold metadata named `{}`; choose another name", name);
    spec.attribute(name, text);
  }
}

// Encodes an image whose row strips `fill(y0, y1, bytes)` lays out in the spec's native format.
template <class Fill>
std::vector<unsigned char> encode(const char* format, const std::filesystem::path& path,
                                  const OIIO::ImageSpec& spec, Fill fill) {
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput memory(file);
  const auto output = OIIO::ImageOutput::create(format, &memory);
  if (output == nullptr)
    fail(ExitCode::machine, path.string(), "this build of OpenImageIO cannot write {} ({})", format,
         OIIO::geterror());
  const auto check = [&](bool good) {
    if (!good) fail(ExitCode::machine, path.string(), "cannot be encoded: {}", output->geterror());
  };
  check(output->open(format, spec));
  std::vector<std::byte> strip(spec.scanline_bytes(true) * std::min<uint32_t>(strip_rows, spec.height));
  for (int y = 0; y < spec.height; y += strip_rows) {
    const int end = std::min<int>(y + strip_rows, spec.height);
    fill(y, end, strip);
    check(output->write_scanlines(y, end, 0, OIIO::TypeUnknown, strip.data()));
  }
  check(output->close());
  return file;
}

std::vector<unsigned char> encode_exr(const std::filesystem::path& path, const Image& image) {
  const size_t count = image.channels.size();
  OIIO::ImageSpec spec(int(image.width), int(image.height), int(count), OIIO::TypeFloat);
  spec.channelnames.clear();
  spec.alpha_channel = -1;
  for (const Channel& channel : image.channels) {
    spec.channelnames.push_back(channel.name);
    spec.channelformats.push_back(channel.ids.empty() ? OIIO::TypeFloat : OIIO::TypeUInt32);
  }
  set_metadata(spec, path, image);
  if (image.camera) {  // under the names by which OpenImageIO knows the standard attributes
    spec.attribute("worldtocamera", OIIO::TypeMatrix44, image.camera->world_to_camera.data());
    spec.attribute("worldtoNDC", OIIO::TypeMatrix44, image.camera->world_to_ndc.data());
  }
  spec.attribute("compression", "zip");
  return encode("exr", path, spec, [&](uint32_t begin, uint32_t end, std::span<std::byte> strip) {
    const size_t first = size_t(begin) * image.width, pixels = size_t(end - begin) * image.width;
    for (size_t c = 0; c < count; ++c) {
      const Channel& channel = image.channels[c];
      const void* samples = channel.ids.empty() ? static_cast<const void*>(channel.values.data() + first)
                                                : static_cast<const void*>(channel.ids.data() + first);
      const auto* source = static_cast<const std::byte*>(samples);
      std::byte* target = strip.data() + 4 * c;
      for (size_t i = 0; i < pixels; ++i) std::memcpy(target + 4 * count * i, source + 4 * i, 4);
    }
  });
}

unsigned char quantise(float value) {
  if (!(value > 0)) return 0;  // NaN too
  return static_cast<unsigned char>(255 * std::min(value, 1.0f) + 0.5f);
}

std::vector<unsigned char> encode_png(const std::filesystem::path& path, const Image& image) {
  std::vector<const Channel*> planes;
  for (const char* name : {"R", "G", "B"}) planes.push_back(image.find(name));
  if (std::count(planes.begin(), planes.end(), nullptr) == 3 && image.find("Y") != nullptr)
    planes = {image.find("Y")};
  if (image.find("A") != nullptr && planes.size() == 3) planes.push_back(image.find("A"));
  for (const Channel* plane : planes) {
    if (plane == nullptr || plane->values.empty())
      fail(ExitCode::usage, path.string(),
           "a PNG holds R G B or Y, which this image has not; write an .exr instead");
  }
  OIIO::ImageSpec spec(int(image.width), int(image.height), int(planes.size()), OIIO::TypeUInt8);
  set_metadata(spec, path, image);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);  // leave the colours as they are
  return encode("png", path, spec, [&](uint32_t begin, uint32_t end, std::span<std::byte> strip) {
    const size_t first = size_t(begin) * image.width, pixels = size_t(end - begin) * image.width;
    for (size_t i = 0; i < pixels; ++i) {
      for (size_t c = 0; c < planes.size(); ++c)
        strip[planes.size() * i + c] = std::byte(quantise(planes[c]->values[first + i]));
    }
  });
}

}  // namespace

void write(const std::filesystem::path& path, const Image& image) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  const bool exr = extension == ".exr";
  if (!exr && extension != ".png")
    fail(ExitCode::usage, path.string(),
         "images are written as .exr or .png; choose one of these extensions");
  check_channels(image);
  const std::vector<unsigned char> file = exr ? encode_exr(path, image) : encode_png(path, image);
  write_file(path, std::as_bytes(std::span(file)));
}

}  // namespace lodestone::image
