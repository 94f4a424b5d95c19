// SPDX-License-Identifier: MIT
// What is written to EXR and PNG is what is read back.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/image/image.h"
#include "pictures.h"
#include "temporary_folder.h"

namespace lodestone::image {
namespace {

using ImageFile = TemporaryFolder;

// Every channel that a render can have; 67 rows, so that the last strip and the last ZIP block are not full.
Image render_like() {
  Image image = noise(33, 67, 1);
  for (const char* name :
       {"A", "depth.Z", "normal.X", "normal.Y", "normal.Z", "uv.U", "uv.V", "lod.L", "steps.N"}) {
    Channel& channel = image.add(name);
    for (size_t i = 0; i < channel.values.size(); ++i) channel.values[i] = float(i) - 1000.25f;
  }
  for (const char* name : {"id.mesh", "id.triangle"}) {
    Channel& channel = image.add_ids(name);
    for (size_t i = 0; i < channel.ids.size(); ++i) channel.ids[i] = uint32_t(i * 2654435761u);
    channel.ids[0] = 0xffffffffu;
  }
  return image;
}

void expect_equal_bits(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (const Channel& channel : a.channels) {
    SCOPED_TRACE(channel.name);
    const Channel* other = b.find(channel.name);
    ASSERT_NE(other, nullptr);
    EXPECT_EQ(channel.ids, other->ids);
    ASSERT_EQ(channel.values.size(), other->values.size());
    for (size_t i = 0; i < channel.values.size(); ++i)
      ASSERT_EQ(std::bit_cast<uint32_t>(channel.values[i]), std::bit_cast<uint32_t>(other->values[i])) << i;
  }
}

ExitCode exit_code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code();
  }
  return ExitCode::done;
}

TEST_F(ImageFile, ExrKeepsEveryFloatAndIdToTheBit) {
  Image image = render_like();
  sample(image, "depth.Z", 0, 0) = std::numeric_limits<float>::infinity();
  sample(image, "depth.Z", 1, 0) = -std::numeric_limits<float>::infinity();
  sample(image, "depth.Z", 2, 0) = std::numeric_limits<float>::quiet_NaN();
  sample(image, "depth.Z", 3, 0) = -0.0f;
  sample(image, "depth.Z", 4, 0) = std::numeric_limits<float>::denorm_min();
  sample(image, "depth.Z", 5, 0) = std::numeric_limits<float>::max();
  write(place("a.exr"), image);
  const Image back = read(place("a.exr"));
  expect_equal_bits(image, back);
  EXPECT_TRUE(back.linear);
}

TEST_F(ImageFile, ExrHoldsIdsAlone) {
  Image image;
  image.width = 3;
  image.height = 1;
  image.add_ids("id.mesh").ids = {0, 16777217, 0xffffffffu};
  write(place("a.exr"), image);
  expect_equal_bits(image, read(place("a.exr")));
}

TEST_F(ImageFile, OrderOfChannelsDoesNotMatter) {
  Image image = render_like();
  write(place("a.exr"), image);
  std::reverse(image.channels.begin(), image.channels.end());
  write(place("b.exr"), image);
  expect_equal_bits(read(place("a.exr")), read(place("b.exr")));
}

TEST_F(ImageFile, MetadataComesBackFromExrAndPng) {
  Image image = plain(2, 2, 0, 0.5f, 1);
  image.metadata = {{"lodestone:version", "0.1.0"},
                    {"lodestone:device", "llvmpipe (LLVM 15.0.6, 256 bits)"},
                    {"lodestone:text", "zwei\nZeilen \xc3\xa4"},
                    {"Software", "Lodestone"},
                    {"Comment", std::string(300, 'x')}};
  for (const char* name : {"a.exr", "a.png"}) {
    write(place(name), image);
    EXPECT_EQ(read(place(name)).metadata, image.metadata) << name;
  }
}

TEST_F(ImageFile, TheCameraComesBackFromExr) {
  Image image = render_like();
  image.camera.emplace();
  for (size_t i = 0; i < 16; ++i) {
    image.camera->world_to_camera[i] = float(i) + 0.1f;
    image.camera->world_to_ndc[i] = -1 / (float(i) + 3);
  }
  write(place("x.exr"), image);
  const Image back = read(place("x.exr"));
  ASSERT_TRUE(back.camera);
  EXPECT_EQ(back.camera->world_to_camera, image.camera->world_to_camera);
  EXPECT_EQ(back.camera->world_to_ndc, image.camera->world_to_ndc);
  EXPECT_TRUE(back.metadata.empty());
  image.camera.reset();
  write(place("y.exr"), image);
  EXPECT_FALSE(read(place("y.exr")).camera);
}

TEST_F(ImageFile, MetadataNamesOfTheFormatAreRefused) {
  for (const char* name : {"channels", "compression", "dataWindow", "displayWindow", "lineOrder", "name",
                           "type", "version", "chunkCount", "view", "tiles", "preview", "envmap", "multiView",
                           "pixelAspectRatio", "screenWindowCenter", "screenWindowWidth", ""}) {
    Image image = plain(2, 2, 0, 0, 0);
    image.metadata[name] = "x";
    EXPECT_EQ(exit_code_of([&] { write(place("a.exr"), image); }), ExitCode::usage) << name;
    EXPECT_FALSE(std::filesystem::exists(place("a.exr"))) << name;
  }
}

TEST_F(ImageFile, EqualImagesGiveEqualBytesAtAnotherTime) {
  Image image = render_like();
  image.metadata["lodestone:version"] = "0.1.0";
  for (const std::string extension : {".exr", ".png"}) {
    write(place("a" + extension), image);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // time stamps count seconds
    write(place("b" + extension), image);
    EXPECT_EQ(read_file(place("a" + extension)), read_file(place("b" + extension))) << extension;
  }
}

TEST_F(ImageFile, PngRoundsClampsAndMakesNanBlack) {
  const float step = 1.0f / 255;
  Image image = plain(8, 1, 0, 0, 0);
  image.channels[0].values = {-1, 0, 0.499f * step, 0.501f * step, 0.5f, 1, 2, std::nanf("")};
  image.channels[1].values[0] = std::numeric_limits<float>::infinity();
  image.channels[1].values[1] = -std::numeric_limits<float>::infinity();
  write(place("a.png"), image);
  const Image back = read(place("a.png"));
  EXPECT_FALSE(back.linear);
  const std::vector<float> expected = {0, 0, 0, 1.0f / 255, 128.0f / 255, 1, 1, 0};
  EXPECT_EQ(back.find("R")->values, expected);
  EXPECT_EQ(back.find("G")->values[0], 1);
  EXPECT_EQ(back.find("G")->values[1], 0);
  EXPECT_EQ(back.find("A"), nullptr);
}

TEST_F(ImageFile, EveryEightBitValueSurvivesPng) {
  Image image = plain(256, 1, 0, 0, 0);
  for (uint32_t i = 0; i < 256; ++i) {
    image.channels[0].values[i] = float(i) / 255;
    image.channels[2].values[i] = float(255 - i) / 255;
  }
  write(place("a.png"), image);
  expect_equal_bits(image, read(place("a.png")));
}

TEST_F(ImageFile, PngAlphaTouchesNoColour) {
  Image image = plain(4, 1, 1, 0.6f, 0.2f);
  image.add("A").values = {0, 0.2f, 0.4f, 1};
  write(place("a.png"), image);
  expect_equal_bits(image, read(place("a.png")));
}

TEST_F(ImageFile, GreyPngIsOneChannelNamedY) {
  Image image;
  image.width = 2;
  image.height = 1;
  image.add("Y").values = {0.2f, 0.8f};
  write(place("a.png"), image);
  expect_equal_bits(image, read(place("a.png")));
}

TEST_F(ImageFile, PngTakesTheColoursAmongOtherChannels) {
  const Image image = render_like();
  write(place("a.png"), image);
  const Image back = read(place("a.png"));
  EXPECT_EQ(back.channels.size(), 4u);
  EXPECT_EQ(back.width, image.width);
  EXPECT_EQ(back.height, image.height);
}

TEST_F(ImageFile, PngWithoutColoursIsWrongUsage) {
  Image image;
  image.width = image.height = 1;
  image.add("depth.Z");
  EXPECT_EQ(exit_code_of([&] { write(place("a.png"), image); }), ExitCode::usage);
  image.add_ids("R");
  image.add("G");
  image.add("B");
  EXPECT_EQ(exit_code_of([&] { write(place("a.png"), image); }), ExitCode::usage);
}

TEST_F(ImageFile, OtherExtensionsAreWrongUsage) {
  for (const char* name : {"a.jpg", "a", "a.exr.gz", ".png"})
    EXPECT_EQ(exit_code_of([&] { write(place(name), plain(1, 1, 0, 0, 0)); }), ExitCode::usage) << name;
}

TEST_F(ImageFile, ExtensionMayBeInCapitals) {
  write(place("A.EXR"), plain(1, 1, 0.25f, 0, 0));
  write(place("A.PNG"), plain(1, 1, 1, 0, 0));
  EXPECT_EQ(read(place("A.EXR")).find("R")->values[0], 0.25f);
  EXPECT_EQ(read(place("A.PNG")).find("R")->values[0], 1);
}

TEST_F(ImageFile, MalformedImagesAreRefusedBeforeAFileExists) {
  Image twice = plain(2, 2, 0, 0, 0);
  twice.add("R");
  Image narrow = plain(2, 2, 0, 0, 0);
  narrow.channels[1].values.pop_back();
  Image both = plain(2, 2, 0, 0, 0);
  both.channels[1].ids.resize(4);
  for (const Image& image : {Image(), twice, narrow, both}) {
    EXPECT_THROW(write(place("a.exr"), image), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(place("a.exr")));
  }
}

TEST_F(ImageFile, PlaceThatCannotBeWrittenIsAFaultOfTheMachine) {
  write_file(place("file"), std::string("not a folder"));
  for (const char* name : {"a.exr", "a.png"}) {
    EXPECT_EQ(exit_code_of([&] { write(place("file") / name, plain(1, 1, 0, 0, 0)); }), ExitCode::machine);
    EXPECT_EQ(exit_code_of([&] { write(std::filesystem::path("/proc") / name, plain(1, 1, 0, 0, 0)); }),
              ExitCode::machine);
  }
  std::filesystem::create_directories(place("folder.exr/full"));
  EXPECT_EQ(exit_code_of([&] { write(place("folder.exr"), plain(1, 1, 0, 0, 0)); }), ExitCode::machine);
}

// A limit on the size of files stands in for a full disk: the system cuts the write short in the same way.
TEST_F(ImageFile, FullDiskLeavesTheOldFileAndNothingElse) {
  for (const char* name : {"a.exr", "a.png"}) {
    write(place(name), plain(1, 1, 1, 1, 1));
    const std::vector<std::byte> old = read_file(place(name));
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit tight = {10000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
    const ExitCode code = exit_code_of([&] { write(place(name), noise(256, 256, 3)); });
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(code, ExitCode::machine) << name;
    EXPECT_EQ(read_file(place(name)), old) << name;
  }
  const auto entries = std::filesystem::directory_iterator(place(""));
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 2);
}

}  // namespace
}  // namespace lodestone::image
