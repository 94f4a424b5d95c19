// SPDX-License-Identifier: MIT
#include "lodestone/scene/decode_image.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "gltf_builder.h"
#include "lodestone/base/file.h"

namespace lodestone::scene {
namespace {

Image decode(const std::string& bytes) {
  return decode_image(std::as_bytes(std::span(bytes)), "test");
}

void expect_bad(const std::string& bytes, const std::string& mentions) {
  try {
    decode(bytes);
    ADD_FAILURE() << "decoded; expected: " << mentions;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_NE(std::string(error.what()).find(mentions), std::string::npos) << error.what();
  }
}

std::string encode(const std::string& extension, int width, int height, int channels, OIIO::TypeDesc type,
                   const void* samples) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / ("image." + extension);
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(path.string());
  EXPECT_TRUE(out && out->open(path.string(), OIIO::ImageSpec(width, height, channels, type)) &&
              out->write_image(type, samples) && out->close());
  const std::vector<std::byte> bytes = read_file(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(DecodeImage, SpreadsEveryNumberOfChannels) {
  EXPECT_EQ(decode(make_png(2, 1, 1, {7, 9})).rgba, (std::vector<uint8_t>{7, 7, 7, 255, 9, 9, 9, 255}));
  EXPECT_EQ(decode(make_png(1, 1, 2, {7, 100})).rgba, (std::vector<uint8_t>{7, 7, 7, 100}));
  EXPECT_EQ(decode(make_png(1, 1, 3, {1, 2, 3})).rgba, (std::vector<uint8_t>{1, 2, 3, 255}));
  EXPECT_EQ(decode(make_png(1, 1, 4, {200, 100, 50, 0})).rgba, (std::vector<uint8_t>{200, 100, 50, 0}))
      << "colour under alpha 0 survives";
}

TEST(DecodeImage, PutsTheTopRowFirst) {
  const Image image = decode(make_png(1, 2, 1, {10, 20}));
  EXPECT_EQ(image.width, 1u);
  EXPECT_EQ(image.height, 2u);
  EXPECT_EQ(image.rgba.at(0), 10);
  EXPECT_EQ(image.rgba.at(4), 20);
}

TEST(DecodeImage, RoundsSixteenBits) {
  const uint16_t samples[] = {0, 65535, 257 * 100, 257 * 100 + 100};
  const Image image = decode(encode("png", 4, 1, 1, OIIO::TypeDesc::UINT16, samples));
  EXPECT_EQ(image.rgba.at(0), 0);
  EXPECT_EQ(image.rgba.at(4), 255);
  EXPECT_EQ(image.rgba.at(8), 100);
  EXPECT_EQ(image.rgba.at(12), 100);
}

TEST(DecodeImage, ReadsJpeg) {
  const std::vector<uint8_t> grey(16 * 8 * 3, 120);
  const Image image = decode(encode("jpg", 16, 8, 3, OIIO::TypeDesc::UINT8, grey.data()));
  EXPECT_EQ(image.width, 16u);
  EXPECT_EQ(image.height, 8u);
  EXPECT_NEAR(image.rgba.at(0), 120, 2);
  EXPECT_EQ(image.rgba.at(3), 255);
}

TEST(DecodeImage, EveryTruncationIsAnError) {
  std::vector<uint8_t> samples(64 * 64 * 3);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = uint8_t(i * i / 7);
  for (const char* format : {"png", "jpg"}) {
    const std::string whole = encode(format, 64, 64, 3, OIIO::TypeDesc::UINT8, samples.data());
    EXPECT_EQ(decode(whole).width, 64u);
    // The last bytes of a PNG are its IEND chunk, without which the image is still whole.
    for (size_t size = 0; size + 16 < whole.size(); size += 37) {
      EXPECT_THROW(decode(whole.substr(0, size)), Error) << format << " " << size << " of " << whole.size();
    }
  }
}

TEST(DecodeImage, UnknownFormatsAreErrors) {
  expect_bad("", "neither PNG, JPEG nor WebP");
  expect_bad("GIF89a....", "neither PNG, JPEG nor WebP");
}

TEST(DecodeImage, SizesThatTheBytesCannotHoldAreErrors) {
  std::string png = make_png(1, 1, 3, {1, 2, 3});
  const auto with_size = [&](uint32_t width, uint32_t height) {
    std::string changed = png;
    for (size_t i = 0; i < 4; ++i) {
      changed[16 + i] = char(width >> (24 - 8 * i));
      changed[20 + i] = char(height >> (24 - 8 * i));
    }
    return changed;
  };
  // The checksum no longer fits either; what matters is that nothing is allocated for these.
  EXPECT_THROW(decode(with_size(0x7fffffff, 0x7fffffff)), Error);
  EXPECT_THROW(decode(with_size(16384, 8192)), Error);
  EXPECT_THROW(decode(with_size(0, 0)), Error);
}

TEST(DecodeImageFile, ReadsOtherFormatsToo) {
  const TemporaryFolder folder;
  const uint8_t samples[] = {1, 2, 3};
  const std::filesystem::path path =
      folder.write("image.tif", encode("tif", 1, 1, 3, OIIO::TypeDesc::UINT8, samples));
  EXPECT_EQ(decode_image_file(path).rgba, (std::vector<uint8_t>{1, 2, 3, 255}));
  EXPECT_THROW(decode_image_file(folder.write("broken.tif", "II*")), Error);
  EXPECT_THROW(decode_image_file(folder.path() / "missing.png"), Error);
}

}  // namespace
}  // namespace lodestone::scene
