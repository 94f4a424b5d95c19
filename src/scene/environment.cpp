// SPDX-License-Identifier: MIT
#include "lodestone/scene/environment.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/base/parallel.h"
#include "lodestone/scene/encoded_image.h"
#include "lodestone/scene/exr_outline.h"
#include "lodestone/scene/mesh_tools.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

constexpr uint64_t max_file_bytes = uint64_t(1) << 32;
// Deflate, which packs best of what is in use, makes at most 1032 bytes of one. The allowance is for small
// pictures of a single value in formats that store those in almost nothing.
constexpr uint64_t max_expansion = 1032, expansion_allowance = uint64_t(1) << 20;
constexpr float brightest = 1e30f;  // as of any light: products with it stay within the range of floats

struct Format {
  const char* name;  // OpenImageIO's
  bool linear;
};

Format format_of(std::string_view bytes, const std::string& file) {
  using namespace std::string_view_literals;
  if (bytes.empty()) fail_input(file, "is empty; expected an equirectangular picture");
  if (bytes.starts_with("#?"sv)) return {"hdr", true};
  if (bytes.starts_with("\x76\x2f\x31\x01"sv)) return {"openexr", true};
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return {"png", false};
  if (bytes.starts_with("\xff\xd8\xff"sv)) return {"jpeg", false};
  fail_input(
      file,
      "byte 0: is neither a Radiance .hdr, an OpenEXR, a PNG nor a JPEG picture; convert it to one of them");
}

std::string reason(const std::string& error) {
  std::string line = error.substr(0, error.find('\n'));
  return line.empty() ? "the data are broken" : line;
}

void check_size(uint64_t width, uint64_t height, uint64_t texel_bytes, uint64_t file_bytes,
                const std::string& file) {
  if (width < 1 || height < 1) fail_input(file, "has no pixels; save the picture again");
  if (width > max_environment_width || height > max_environment_height) {
    fail_input(file, "has {} x {} pixels, more than {} x {}; reduce it", width, height, max_environment_width,
               max_environment_height);
  }
  if (width * height >
      (expansion_allowance + max_expansion * file_bytes) / std::max<uint64_t>(texel_bytes, 1)) {
    fail_input(file, "claims {} x {} pixels, more than its {} bytes can hold; get the whole file", width,
               height, file_bytes);
  }
}

// The format, of a file that may be what it claims.
Format check_file(const std::string& file, uint64_t& file_bytes) {
  const std::vector<std::byte> contents = read_file(file, max_file_bytes);
  file_bytes = contents.size();
  const Format format = format_of(as_text(contents), file);
  check_encoded_image(contents, file);
  if (format.name == std::string_view("openexr")) {
    const ExrOutline outline = read_exr_outline(file, as_text(contents));
    check_size(outline.width, outline.height, outline.texel_bytes, file_bytes, file);
  }
  return format;
}

std::unique_ptr<OIIO::ImageInput> open_input(const std::string& file, const Format& format,
                                             uint64_t file_bytes) {
  OIIO::ImageSpec config, spec;
  config.attribute("oiio:UnassociatedAlpha", 1);  // light is not multiplied by alpha
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format.name);
  if (!input)
    fail(ExitCode::machine, file, "OpenImageIO was built without {}; install one with it", format.name);
  if (!input->open(file, spec, config)) {
    fail_input(file, "cannot be decoded ({}); get the whole file or convert it again",
               reason(input->geterror()));
  }
  if (spec.width < 0 || spec.height < 0 || spec.nchannels < 1 || spec.depth > 1 || spec.deep)
    fail_input(file, "is no flat picture; save it as one");
  check_size(uint64_t(spec.width), uint64_t(spec.height), spec.pixel_bytes(true), file_bytes, file);
  if (spec.get_int_attribute("Orientation", 1) != 1)
    fail_input(file, "is stored turned or mirrored; save it with its upper left pixel first");
  return input;
}

// Where red, green and blue stand, or three times where grey does.
std::vector<int> color_channels(const OIIO::ImageSpec& spec, const std::string& file) {
  std::vector<int> colors, others;
  for (const char* name : {"R", "G", "B"}) {
    if (const int c = spec.channelindex(name); c >= 0) colors.push_back(c);
  }
  if (colors.size() == 3) return colors;
  for (int c = 0; c < spec.nchannels; ++c) {
    if (c != spec.alpha_channel) others.push_back(c);
  }
  if (others.size() == 1) return {others[0], others[0], others[0]};
  std::string names;
  for (const std::string& name : spec.channelnames) names += (names.empty() ? "" : ", ") + name;
  fail_input(file, "has the channels {}; save it with R, G and B, or as a grey picture", names);
}

std::vector<glm::vec3> read_pixels(OIIO::ImageInput& input, const std::string& file) {
  const OIIO::ImageSpec spec = input.spec();
  const std::vector<int> channels = color_channels(spec, file);
  std::vector<glm::vec3> pixels(size_t(spec.width) * size_t(spec.height));
  const auto read = [&](int first, int count, int to) {
    if (!input.read_image(0, 0, first, first + count, OIIO::TypeFloat, &pixels[0][to], sizeof(glm::vec3))) {
      fail_input(file, "cannot be decoded ({}); get the whole file or convert it again",
                 reason(input.geterror()));
    }
  };
  if (channels[1] == channels[0] + 1 && channels[2] == channels[0] + 2) {
    read(channels[0], 3, 0);
  } else {
    for (int to = 0; to < 3; ++to) read(channels[size_t(to)], 1, to);
  }
  return pixels;
}

void check_radiance(const Environment& environment) {
  for (size_t i = 0; i < environment.radiance.size(); ++i) {
    const glm::vec3& radiance = environment.radiance[i];
    const bool good = radiance.x >= 0 && radiance.x <= brightest && radiance.y >= 0 &&
                      radiance.y <= brightest && radiance.z >= 0 && radiance.z <= brightest;
    if (good) continue;
    fail_input(environment.file, "column {}, row {}: {}, {}, {} is no radiance; cut the picture to 0 to 1e30",
               i % environment.width, i / environment.width, radiance.x, radiance.y, radiance.z);
  }
}

}  // namespace

Environment load_environment(const std::filesystem::path& path) {
  Environment environment;
  environment.file = path.string();
  uint64_t file_bytes = 0;
  const Format format = check_file(environment.file, file_bytes);
  const auto input = open_input(environment.file, format, file_bytes);
  environment.width = static_cast<uint32_t>(input->spec().width);
  environment.height = static_cast<uint32_t>(input->spec().height);
  environment.radiance = read_pixels(*input, environment.file);
  if (!format.linear) {
    parallel_for(environment.radiance.size(), 1 << 14, [&](uint64_t begin, uint64_t end) {
      for (uint64_t i = begin; i < end; ++i) {
        for (glm::length_t c = 0; c < 3; ++c)
          environment.radiance[i][c] = decode_srgb(environment.radiance[i][c]);
      }
    });
  }
  check_radiance(environment);
  if (environment.width != 2 * environment.height) {
    log::warn(
        fmt::format("{}: has {} x {} pixels; an equirectangular picture is twice as wide as high, so this "
                    "one is stretched",
                    environment.file, environment.width, environment.height));
  }
  return environment;
}

}  // namespace lodestone::scene
