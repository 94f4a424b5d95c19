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

// The PNG checksum, bit by bit.
uint32_t crc_of(std::string_view bytes) {
  uint32_t crc = 0xffffffff;
  for (char byte : bytes) {
    crc ^= uint8_t(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xedb88320 & (0u - (crc & 1)));
  }
  return ~crc;
}

void put_big_endian(std::string& bytes, size_t at, uint32_t value) {
  for (size_t i = 0; i < 4; ++i) bytes[at + i] = char(value >> (24 - 8 * i));
}

TEST(DecodeImage, SizesThatTheBytesCannotHoldAreErrors) {
  const auto with_size = [](uint32_t width, uint32_t height) {
    std::string png = make_png(1, 1, 3, {1, 2, 3});
    put_big_endian(png, 16, width);
    put_big_endian(png, 20, height);
    put_big_endian(png, 29, crc_of(std::string_view(png).substr(12, 17)));
    return png;
  };
  EXPECT_EQ(decode(with_size(1, 1)).width, 1u);
  expect_bad(with_size(16384, 8192), "can hold");
  expect_bad(with_size(16384, 8193), "reduce it");
  expect_bad(with_size(16385, 1), "reduce it");
  EXPECT_THROW(decode(with_size(0x7fffffff, 0x7fffffff)), Error);
  EXPECT_THROW(decode(with_size(0, 0)), Error);
}

TEST(DecodeImage, DamagedChunksAreErrors) {
  const std::string png = make_png(8, 8, 3, std::vector<uint8_t>(8 * 8 * 3, 50));
  for (size_t at = 8; at < png.size(); ++at) {
    std::string damaged = png;
    damaged[at] = char(damaged[at] ^ 0x10);
    EXPECT_THROW(decode(damaged), Error) << at << " of " << png.size();
  }
  EXPECT_EQ(decode(png + "behind the end").width, 8u);
}

TEST(DecodeImage, AJpegEndsAfterItsThumbnail) {
  std::vector<uint8_t> samples(64 * 64 * 3);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = uint8_t(i * i / 7);
  std::string jpeg = encode("jpg", 64, 64, 3, OIIO::TypeDesc::UINT8, samples.data());
  // An application segment of 8 bytes that holds an end marker.
  jpeg.insert(2, std::string("\xff\xe5\x00\x08\xff\xd8\xff\xd9\x00\x00", 10));
  EXPECT_EQ(decode(jpeg).width, 64u);
  expect_bad(jpeg.substr(0, jpeg.size() / 2), "cut short");
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
