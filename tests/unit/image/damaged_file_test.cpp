// SPDX-License-Identifier: MIT
// Damaged and hostile files end in Error(bad_input), without a word from the codec libraries.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstring>
#include <random>
#include <span>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/image/image.h"
#include "pictures.h"
#include "temporary_folder.h"

namespace lodestone::image {
namespace {

using DamagedFile = TemporaryFolder;
using Bytes = std::vector<std::byte>;

// The message of the Error(bad_input) that reading throws; empty where it reads.
std::string refusal(const std::filesystem::path& path) {
  try {
    read(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input) << error.what();
    EXPECT_EQ(std::string(error.what()).find(path.string() + ": "), 0u) << error.what();
    return error.what();
  }
  return "";
}

Image with_ids() {
  Image image = noise(40, 50, 2);
  image.add_ids("id.mesh").ids.assign(image.pixels(), 7);
  image.metadata["lodestone:version"] = "0.1.0";
  return image;
}

// Some 250 lengths: all short ones, where headers end, then evenly to one byte short of the whole.
std::vector<size_t> cut_lengths(size_t size) {
  std::vector<size_t> lengths;
  for (size_t length = 0; length < size; length += length < 100 ? 1 : std::max<size_t>(1, size / 150))
    lengths.push_back(length);
  lengths.push_back(size - 1);
  return lengths;
}

TEST_F(DamagedFile, ExrCutAnywhereIsRefusedSilently) {
  write(place("whole.exr"), with_ids());
  const Bytes whole = read_file(place("whole.exr"));
  testing::internal::CaptureStderr();
  for (const size_t length : cut_lengths(whole.size())) {
    write_file(place("cut.exr"), std::span(whole).first(length));
    EXPECT_NE(refusal(place("cut.exr")), "") << length << " of " << whole.size();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(DamagedFile, PngCutAnywhereIsRefusedSilently) {
  write(place("whole.png"), with_ids());
  const Bytes whole = read_file(place("whole.png"));
  testing::internal::CaptureStderr();
  for (const size_t length : cut_lengths(whole.size())) {
    write_file(place("cut.png"), std::span(whole).first(length));
    EXPECT_NE(refusal(place("cut.png")), "") << length << " of " << whole.size();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(DamagedFile, FlippedBytesNeverCrash) {
  for (const char* name : {"whole.exr", "whole.png"}) {
    write(place(name), with_ids());
    const Bytes whole = read_file(place(name));
    const auto flipped = place(std::string("flipped") + std::filesystem::path(name).extension().string());
    std::mt19937 random(5);
    testing::internal::CaptureStderr();
    uint32_t refused = 0;
    for (int round = 0; round < 400; ++round) {
      Bytes bytes = whole;
      // Half of the damage goes to the header, where it can do more.
      const size_t range = round % 2 == 0 ? std::min<size_t>(400, bytes.size()) : bytes.size();
      for (int i = 0; i < 3; ++i) bytes[random() % range] = std::byte(random());
      write_file(flipped, bytes);
      if (!refusal(flipped).empty()) ++refused;
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << name;
    EXPECT_GT(refused, 200u) << name;
  }
}

TEST_F(DamagedFile, WhatIsNoImageIsRefused) {
  testing::internal::CaptureStderr();
  EXPECT_NE(refusal(place("missing.exr")).find("no such file"), std::string::npos);
  std::filesystem::create_directories(place("folder.png"));
  EXPECT_NE(refusal(place("folder.png")).find("not a regular file"), std::string::npos);
  for (const char* name : {"a.exr", "a.png", "a.tif", "a.unknown", "noextension"}) {
    write_file(place(name), std::string());
    EXPECT_NE(refusal(place(name)).find("is empty"), std::string::npos) << name;
    write_file(place(name), std::string("this is a text and no image\n"));
    EXPECT_NE(refusal(place(name)), "") << name;
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

void put_number(Bytes& bytes, uint32_t number) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(std::byte(number >> shift));
}

void put_chunk(Bytes& bytes, std::string_view type, std::span<const std::byte> data) {
  put_number(bytes, uint32_t(data.size()));
  const size_t checked = bytes.size();
  for (const char letter : type) bytes.push_back(std::byte(letter));
  bytes.insert(bytes.end(), data.begin(), data.end());
  const auto* start = reinterpret_cast<const Bytef*>(bytes.data() + checked);
  put_number(bytes, uint32_t(crc32(0, start, uInt(bytes.size() - checked))));
}

// A well-formed PNG that claims width x height 8-bit RGB pixels and holds none.
Bytes hollow_png(uint32_t width, uint32_t height) {
  Bytes bytes, header;
  for (const char c : std::string_view("\x89PNG\r\n\x1a\n")) bytes.push_back(std::byte(c));
  put_number(header, width);
  put_number(header, height);
  for (const int value : {8, 2, 0, 0, 0}) header.push_back(std::byte(value));
  put_chunk(bytes, "IHDR", header);
  put_chunk(bytes, "IDAT", {});
  put_chunk(bytes, "IEND", {});
  return bytes;
}

TEST_F(DamagedFile, AbsurdSizesAreRefusedBeforeMemoryIsTaken) {
  for (const auto& [width, height] :
       {std::array<uint32_t, 2>{16384, 16384}, {1000000, 1000000}, {0x7fffffff, 0x7fffffff}}) {
    write_file(place("a.png"), hollow_png(width, height));
    EXPECT_NE(refusal(place("a.png")), "") << width << " x " << height;
  }
  // 16384 x 16384 is fine for the library, and ours to refuse.
  write_file(place("a.png"), hollow_png(16384, 16384));
  EXPECT_NE(refusal(place("a.png")).find("16384 x 16384"), std::string::npos);
}

TEST_F(DamagedFile, AbsurdExrWindowIsRefused) {
  write(place("a.exr"), plain(2, 2, 0, 0, 0));
  Bytes bytes = read_file(place("a.exr"));
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const size_t window = text.find("dataWindow");
  ASSERT_NE(window, std::string_view::npos);
  const size_t values = window + 11 + 6 + 4;  // behind both names, their zeros and the size
  for (const int32_t last : {0x7ffffffe, 1000000, 65535}) {
    std::memcpy(&bytes[values + 8], &last, 4);
    std::memcpy(&bytes[values + 12], &last, 4);
    write_file(place("b.exr"), bytes);
    EXPECT_NE(refusal(place("b.exr")), "") << last;
  }
}

}  // namespace
}  // namespace lodestone::image
