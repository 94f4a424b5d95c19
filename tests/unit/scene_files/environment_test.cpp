// SPDX-License-Identifier: MIT
#include "lodestone/scene/environment.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lodestone/base/file.h"
#include "lodestone/scene/mesh_tools.h"
#include "scene_files.h"

namespace lodestone::scene::test {
namespace {

const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();

class EnvironmentFile : public testing::Test {
 protected:
  // In the format of the name's extension, its channels named as given.
  template <class T>
  std::filesystem::path write(const std::string& name, int width, int height, const std::vector<T>& values,
                              std::vector<std::string> channels = {}, int orientation = 1) const {
    const std::filesystem::path path = folder_.path() / name;
    const auto output = OIIO::ImageOutput::create(path.string());
    const OIIO::TypeDesc type(OIIO::BaseTypeFromC<T>::value);
    OIIO::ImageSpec spec(width, height, static_cast<int>(values.size()) / (width * height), type);
    if (!channels.empty()) spec.channelnames = std::move(channels);
    if (spec.nchannels == 2 || spec.nchannels == 4) spec.alpha_channel = spec.nchannels - 1;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (orientation != 1) spec.attribute("Orientation", orientation);
    EXPECT_TRUE(output->open(path.string(), spec));
    EXPECT_TRUE(output->write_image(type, values.data()));
    EXPECT_TRUE(output->close());
    return path;
  }

  // What follows the file's name in the message with which it is refused.
  static std::string refusal(const std::filesystem::path& path) {
    try {
      load_environment(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input) << error.what();
      const std::string message = error.what(), subject = path.string() + ": ";
      EXPECT_TRUE(message.starts_with(subject)) << message;
      return message.substr(std::min(message.size(), subject.size()));
    }
    ADD_FAILURE() << path << " was loaded";
    return {};
  }

  // A valid scene with it, or an Error(bad_input).
  static bool loads(const std::filesystem::path& path) {
    try {
      Scene scene;
      scene.environment = load_environment(path);
      validate(scene);
      return true;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input) << error.what();
      return false;
    }
  }

  std::filesystem::path rewrite(const std::string& name, std::span<const std::byte> bytes) const {
    return folder_.write(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }

  TemporaryFolder folder_;
};

// Two by one: red, then twice as bright green. Powers of two, which RGBE holds exactly.
const std::vector<float> two_colors = {1, 0, 0, 0, 2, 0};

TEST_F(EnvironmentFile, IsReadFromTheTopLeftInLinearFormats) {
  for (const char* name : {"a.hdr", "a.exr"}) {
    const Environment environment = load_environment(write<float>(name, 2, 1, two_colors));
    EXPECT_EQ(environment.file, (folder_.path() / name).string());
    EXPECT_EQ(environment.width, 2u);
    EXPECT_EQ(environment.height, 1u);
    ASSERT_EQ(environment.radiance.size(), 2u);
    EXPECT_TRUE(near(environment.radiance[0], {1, 0, 0}, 0.01f)) << name;
    EXPECT_TRUE(near(environment.radiance[1], {0, 2, 0}, 0.02f)) << name;
  }
}

TEST_F(EnvironmentFile, IsDecodedWhereItIsEncodedBySrgb) {
  const Environment eight = load_environment(write<uint8_t>("a.png", 2, 1, {255, 128, 0, 51, 51, 51}));
  EXPECT_TRUE(near(eight.radiance[0], {1, decode_srgb(128 / 255.0f), 0}));
  EXPECT_TRUE(near(eight.radiance[1], glm::vec3(decode_srgb(0.2f))));
  const Environment sixteen = load_environment(write<uint16_t>("b.png", 2, 1, {65535, 0, 0, 0, 13107, 0}));
  EXPECT_TRUE(near(sixteen.radiance[1], {0, decode_srgb(0.2f), 0}));
  std::vector<uint8_t> grey(size_t(32) * 16 * 3, 188);
  const Environment jpeg = load_environment(write<uint8_t>("c.jpg", 32, 16, grey));
  EXPECT_TRUE(near(jpeg.radiance[100], glm::vec3(decode_srgb(188 / 255.0f)), 0.01f));
}

TEST_F(EnvironmentFile, MayBeGreyAndHaveAlphaAndChannelsBesides) {
  EXPECT_TRUE(near(load_environment(write<float>("a.exr", 2, 1, {3, 5}, {"Y"})).radiance[1], glm::vec3(5)));
  EXPECT_TRUE(
      near(load_environment(write<uint8_t>("a.png", 2, 1, {255, 0, 0, 255})).radiance[0], glm::vec3(1)));
  const auto alpha = write<float>("b.exr", 2, 1, {1, 2, 3, 0, 4, 5, 6, 0.5f});
  EXPECT_TRUE(near(load_environment(alpha).radiance[1], {4, 5, 6}));
  const auto more = write<float>("c.exr", 2, 1, {9, 3, 2, 1, 9, 6, 5, 4}, {"depth.Z", "B", "G", "R"});
  EXPECT_TRUE(near(load_environment(more).radiance[1], {4, 5, 6}));
}

TEST_F(EnvironmentFile, IsStretchedWithAWarningWhereItIsNotTwiceAsWideAsHigh) {
  const auto square = write<float>("a.exr", 1, 2, two_colors), good = write<float>("b.exr", 2, 1, two_colors);
  testing::internal::CaptureStderr();
  EXPECT_TRUE(loads(good));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  testing::internal::CaptureStderr();
  EXPECT_TRUE(loads(square));
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("warning: " + square.string() + ": has 1 x 2 pixels"), std::string::npos) << said;
}

TEST_F(EnvironmentFile, IsRefusedWithThePlaceWhereASampleIsNoRadiance) {
  for (const float bad : {-0.5f, inf, -inf, nan, 2e30f}) {
    const std::string said = refusal(write<float>(
        "a.exr", 4, 2, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, bad, 1, 1, 1, 1}));
    EXPECT_EQ(said.rfind("column 2, row 1: ", 0), 0u) << said;
    EXPECT_NE(said.find("cut the picture"), std::string::npos) << said;
  }
}

TEST_F(EnvironmentFile, IsRefusedWithoutColors) {
  EXPECT_EQ(refusal(write<float>("a.exr", 2, 1, {1, 2, 3, 4}, {"X", "Z"})),
            "has the channels X, Z; save it with R, G and B, or as a grey picture");
}

TEST_F(EnvironmentFile, IsRefusedWhereItIsStoredTurned) {
  const std::string said = refusal(write<uint8_t>("a.jpg", 2, 1, {1, 2, 3, 4, 5, 6}, {}, 6));
  EXPECT_NE(said.find("turned or mirrored"), std::string::npos) << said;
}

TEST_F(EnvironmentFile, IsRefusedWhereItIsSomethingElse) {
  EXPECT_NE(refusal(folder_.write("a.hdr", "")).find("is empty"), std::string::npos);
  EXPECT_EQ(refusal(folder_.write("a.hdr", "solid box")).rfind("byte 0: is neither", 0), 0u);
  EXPECT_NE(refusal(folder_.path() / "absent.hdr"), "");
  EXPECT_NE(refusal(folder_.path()), "");
}

TEST_F(EnvironmentFile, IsRefusedWhereItClaimsToBeTooLarge) {
  const auto header = [&](const std::string& size) {
    return folder_.write("a.hdr",
                         "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n" + std::string(64, '\1'));
  };
  EXPECT_NE(refusal(header("-Y 8193 +X 16384")).find("more than 16384 x 8192"), std::string::npos);
  EXPECT_NE(refusal(header("-Y 4 +X 100000000")).find("more than 16384 x 8192"), std::string::npos);
  EXPECT_NE(refusal(header("-Y 8192 +X 16384")).find(" bytes can hold"), std::string::npos);
  EXPECT_FALSE(loads(header("-Y -1 +X 8")));
  EXPECT_FALSE(loads(header("-Y 0 +X 0")));
  EXPECT_FALSE(loads(header("")));
}

std::vector<float> smooth_values(int width, int height) {
  std::vector<float> values;
  for (int i = 0; i < width * height * 3; ++i) values.push_back(static_cast<float>(i % 17) * 0.25f);
  return values;
}

// More of this in corpus_test.
TEST_F(EnvironmentFile, CutShortIsRefusedOrLoads) {
  std::vector<uint8_t> bytes(size_t(16) * 8 * 3, 90);
  for (const auto& path : {write<float>("a.hdr", 16, 8, smooth_values(16, 8)),
                           write<float>("a.exr", 16, 8, smooth_values(16, 8)),
                           write<uint8_t>("a.png", 16, 8, bytes), write<uint8_t>("a.jpg", 16, 8, bytes)}) {
    const std::vector<std::byte> whole = read_file(path);
    EXPECT_TRUE(loads(path));
    const std::string name = "cut" + path.extension().string();
    for (size_t length = 0; length < whole.size(); length += 5) {
      SCOPED_TRACE(name + " at " + std::to_string(length));
      const bool loaded = loads(rewrite(name, std::span(whole).first(length)));
      // Half of a picture is none.
      if (length < whole.size() / 2) {
        EXPECT_FALSE(loaded);
      }
    }
  }
}

}  // namespace
}  // namespace lodestone::scene::test
