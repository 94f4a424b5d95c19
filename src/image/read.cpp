// SPDX-License-Identifier: MIT
// Images from disk: hostile until shown to be whole and of sensible size.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string_view>
#include <system_error>

#include "lodestone/base/error.h"
#include "lodestone/image/image.h"
#include "lodestone/image/png_check.h"

namespace lodestone::image {
namespace {
namespace fs = std::filesystem;

// Attributes in which OpenImageIO describes the file rather than what somebody wrote into it.
bool describes_the_file(std::string_view name) {
  return name.starts_with("oiio:") || name.starts_with("openexr:") || name.starts_with("png:") ||
         name == "compression";
}

void check_spec(const std::string& file, const OIIO::ImageSpec& spec) {
  if (spec.deep) fail_input(file, "is a deep image; flatten it first");
  if (spec.depth > 1) fail_input(file, "is a volume, not an image");
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) fail_input(file, "has no pixels");
  const uint64_t pixels = uint64_t(spec.width) * uint64_t(spec.height);
  // Divide: a product of three may overflow.
  if (pixels > max_samples / uint64_t(spec.nchannels))
    fail_input(file, "claims {} x {} pixels of {} channels, more than the {} samples that are read",
               spec.width, spec.height, spec.nchannels, max_samples);
}

template <class Integer>
void normalise(const std::byte* source, size_t stride, std::vector<float>& values) {
  for (size_t i = 0; i < values.size(); ++i) {
    Integer sample;
    std::memcpy(&sample, source + stride * i, sizeof sample);
    values[i] = float(sample) / float(std::numeric_limits<Integer>::max());
  }
}

// Takes one channel out of interleaved pixels of `stride` bytes.
void unpack(const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const std::byte* source, size_t stride,
            Channel& channel) {
  const size_t pixels = size_t(spec.width) * size_t(spec.height);
  if (type == OIIO::TypeUInt32) {
    channel.ids.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) std::memcpy(&channel.ids[i], source + stride * i, 4);
    return;
  }
  channel.values.resize(pixels);
  if (type == OIIO::TypeUInt8) return normalise<uint8_t>(source, stride, channel.values);
  if (type == OIIO::TypeUInt16) return normalise<uint16_t>(source, stride, channel.values);
  OIIO::convert_image(1, spec.width, spec.height, 1, source, type, OIIO::stride_t(stride), OIIO::AutoStride,
                      OIIO::AutoStride, channel.values.data(), OIIO::TypeFloat, OIIO::AutoStride,
                      OIIO::AutoStride, OIIO::AutoStride);
}

std::optional<CameraMatrices> camera_of(const OIIO::ImageSpec& spec) {
  const auto* to_camera = spec.find_attribute("worldtocamera", OIIO::TypeMatrix44);
  const auto* to_ndc = spec.find_attribute("worldtoNDC", OIIO::TypeMatrix44);
  if (to_camera == nullptr || to_ndc == nullptr) return std::nullopt;
  CameraMatrices camera;
  std::memcpy(camera.world_to_camera.data(), to_camera->data(), sizeof camera.world_to_camera);
  std::memcpy(camera.world_to_ndc.data(), to_ndc->data(), sizeof camera.world_to_ndc);
  return camera;
}

Image read_open(const std::string& file, OIIO::ImageInput& input) {
  const OIIO::ImageSpec spec = input.spec();
  check_spec(file, spec);
  const size_t stride = spec.pixel_bytes(true);
  // Left uninitialised: of a damaged file that claims a gigabyte, no page is touched.
  const auto native =
      std::make_unique_for_overwrite<std::byte[]>(stride * size_t(spec.width) * size_t(spec.height));
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeUnknown, native.get()))
    fail_input(file, "is damaged or cut short: {}", input.geterror());

  Image image;
  image.width = uint32_t(spec.width);
  image.height = uint32_t(spec.height);
  image.linear = false;
  for (int c = 0; c < spec.nchannels; ++c) {
    const OIIO::TypeDesc type = spec.channelformat(c);
    image.linear |= type.is_floating_point();
    Channel channel;
    channel.name = spec.channelnames[size_t(c)];
    if (image.find(channel.name) != nullptr) fail_input(file, "has two channels named {}", channel.name);
    unpack(spec, type, native.get() + spec.pixel_bytes(0, c, true), stride, channel);
    image.channels.push_back(std::move(channel));
  }
  image.camera = camera_of(spec);
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    const std::string name = attribute.name().string();
    if (attribute.type() == OIIO::TypeString && !describes_the_file(name))
      image.metadata[name] = attribute.get_string();
  }
  return image;
}

}  // namespace

Image read(const fs::path& path) {
  const std::string file = path.string();
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (!fs::exists(status)) fail_input(file, "no such file; check the path");
  if (!fs::is_regular_file(status)) fail_input(file, "is not a regular file");
  if (fs::file_size(path, failed) == 0 && !failed) fail_input(file, "is empty");
  check_png(path);
  try {
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);  // leave the colours as they are
    const auto input = OIIO::ImageInput::open(file, &hints);
    if (input == nullptr) fail_input(file, "is no image that can be read: {}", OIIO::geterror());
    return read_open(file, *input);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // of a codec library
    fail_input(file, "is damaged: {}", error.what());
  }
}

}  // namespace lodestone::image
