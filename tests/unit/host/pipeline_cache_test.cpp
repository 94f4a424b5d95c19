// SPDX-License-Identifier: MIT
#include "lodestone/host/pipeline_cache.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace lodestone::host {
namespace {

std::vector<std::byte> some_data() {
  std::vector<std::byte> data;
  for (int i = 0; i < 1000; ++i) data.push_back(std::byte(i * 7 & 255));
  return data;
}

TEST(PipelineCacheFile, ReturnsItsData) {
  EXPECT_EQ(unpack_pipeline_cache("key", pack_pipeline_cache("key", some_data())), some_data());
  EXPECT_TRUE(unpack_pipeline_cache("key", pack_pipeline_cache("key", {})).empty());
}

TEST(PipelineCacheFile, GivesNothingForAnotherKey) {
  const std::vector<std::byte> file = pack_pipeline_cache("key", some_data());
  EXPECT_TRUE(unpack_pipeline_cache("kez", file).empty());
  EXPECT_TRUE(unpack_pipeline_cache("ke", file).empty());
  EXPECT_TRUE(unpack_pipeline_cache("key1", file).empty());
}

TEST(PipelineCacheFile, GivesNothingWhereAnyByteIsWrongOrMissing) {
  const std::vector<std::byte> file = pack_pipeline_cache("key", some_data());
  for (size_t i = 0; i < file.size(); ++i) {
    std::vector<std::byte> damaged = file;
    damaged[i] ^= std::byte(1);
    ASSERT_TRUE(unpack_pipeline_cache("key", damaged).empty()) << "byte " << i;
    ASSERT_TRUE(unpack_pipeline_cache("key", std::span(file).first(i)).empty()) << "cut at " << i;
  }
}

TEST(PipelineCacheFolder, FollowsTheEnvironment) {
  setenv("HOME", "/home/somebody", 1);
  setenv("XDG_CACHE_HOME", "/var/cache/x", 1);
  EXPECT_EQ(default_cache_folder(), "/var/cache/x/lodestone");
  setenv("XDG_CACHE_HOME", "relative", 1);
  EXPECT_EQ(default_cache_folder(), "/home/somebody/.cache/lodestone");
  unsetenv("XDG_CACHE_HOME");
  unsetenv("HOME");
  EXPECT_EQ(default_cache_folder(), std::nullopt);
}

}  // namespace
}  // namespace lodestone::host
