// SPDX-License-Identifier: MIT
// Replays the corpus of the fuzzers and all that they found: every file loads or is refused as bad input.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "load_bytes.h"
#include "lodestone/base/file.h"

namespace lodestone::fuzz {
namespace {

const std::filesystem::path fuzz_folder = std::filesystem::path(LODESTONE_SOURCE_DIR) / "tests" / "fuzz";

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class Corpus : public testing::TestWithParam<std::string> {
 protected:
  ScratchFolder folder_;
};

TEST_P(Corpus, SeedsAreValidScenes) {
  const auto seeds = files_in(fuzz_folder / "corpus" / GetParam());
  EXPECT_FALSE(seeds.empty());
  for (const std::filesystem::path& seed : seeds) {
    SCOPED_TRACE(seed);
    EXPECT_NO_THROW(EXPECT_TRUE(load_bytes(GetParam(), read_file(seed), folder_.path())));
  }
}

TEST_P(Corpus, FindsLoadOrAreRefused) {
  for (const std::filesystem::path& find : files_in(fuzz_folder / "finds" / GetParam())) {
    SCOPED_TRACE(find);
    EXPECT_NO_THROW(load_bytes(GetParam(), read_file(find), folder_.path()));
  }
}

TEST_P(Corpus, SeedsCutShortAnywhereLoadOrAreRefused) {
  for (const std::filesystem::path& seed : files_in(fuzz_folder / "corpus" / GetParam())) {
    const std::vector<std::byte> bytes = read_file(seed);
    for (size_t length = 0; length < bytes.size(); ++length) {
      SCOPED_TRACE(seed.string() + " cut to " + std::to_string(length));
      EXPECT_NO_THROW(load_bytes(GetParam(), std::span(bytes).first(length), folder_.path()));
    }
  }
}

TEST_P(Corpus, SeedsWithAnyByteChangedLoadOrAreRefused) {
  for (const std::filesystem::path& seed : files_in(fuzz_folder / "corpus" / GetParam())) {
    std::vector<std::byte> bytes = read_file(seed);
    for (size_t at = 0; at < bytes.size(); ++at) {
      const std::byte original = bytes[at];
      for (const int value : {0x00, 0x2d, 0x39, 0x7f, 0xff}) {  // among them `-` and `9`
        SCOPED_TRACE(seed.string() + " byte " + std::to_string(at) + " set to " + std::to_string(value));
        bytes[at] = static_cast<std::byte>(value);
        EXPECT_NO_THROW(load_bytes(GetParam(), bytes, folder_.path()));
      }
      bytes[at] = original;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Corpus,
                         testing::Values("gltf", "glb", "obj", "ply", "stl", "height_map", "environment"),
                         [](const testing::TestParamInfo<std::string>& file) { return file.param; });

}  // namespace
}  // namespace lodestone::fuzz
