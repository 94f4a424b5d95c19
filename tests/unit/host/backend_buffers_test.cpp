// SPDX-License-Identifier: MIT
// Buffers of the Vulkan back end: what goes in comes out, in the order of the calls.
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "device_fixture.h"

namespace lodestone::host {
namespace {

class BackendBuffers : public SetupTest {};
INSTANTIATE_TEST_SUITE_P(Devices, BackendBuffers, all_setups, setup_name);

std::vector<uint32_t> counting_words(size_t count) {
  std::vector<uint32_t> words(count);
  std::iota(words.begin(), words.end(), 1u);
  return words;
}

TEST_P(BackendBuffers, ReturnWhatWasUploaded) {
  const auto backend = make();
  const std::vector<uint32_t> words = counting_words(10000);
  const render::Buffer buffer(*backend, {"words", words.size(), 4});
  upload_words(*backend, buffer.id(), words);
  EXPECT_EQ(download_words(*backend, buffer.id(), words.size()), words);
  backend->finish();
}

TEST_P(BackendBuffers, StartAsZero) {
  const auto backend = make();
  for (int round = 0; round < 3; ++round) {
    // Memory of a buffer that is gone may be used again.
    const render::Buffer buffer(*backend, {"words", 5000, 4});
    EXPECT_EQ(download_words(*backend, buffer.id(), 5000), std::vector<uint32_t>(5000, 0));
    upload_words(*backend, buffer.id(), counting_words(5000));
  }
  backend->finish();
}

TEST_P(BackendBuffers, TakePartialUploadsAndDownloadsAtByteOffsets) {
  const auto backend = make();
  const render::Buffer buffer(*backend, {"bytes", 10000, 4});
  const std::vector<std::byte> part(7, std::byte(0xab));
  backend->upload(buffer.id(), part, 16381);
  std::vector<std::byte> got(9);
  backend->download(buffer.id(), got, 16379);
  std::vector<std::byte> expected(9, std::byte(0));
  std::fill(expected.begin() + 2, expected.end(), std::byte(0xab));
  EXPECT_EQ(got, expected);
  backend->finish();
}

TEST_P(BackendBuffers, MayBeEmpty) {
  const auto backend = make();
  const render::Buffer from(*backend, {"from", 0, 4});
  const render::Buffer to(*backend, {"to", 0, 4});
  backend->upload(from.id(), {});
  run_pass(*backend, copy_pass, {from.id(), to.id()}, {0u}, 0);
  run_pass(*backend, copy_pass, {from.id(), to.id()}, {0u}, 64);
  backend->download(to.id(), {});
  EXPECT_EQ(backend->finish().size(), 2u);
  EXPECT_EQ(backend->desc(from.id()).elements, 0u);
}

TEST_P(BackendBuffers, RejectAccessOutsideTheirBounds) {
  const auto backend = make();
  const render::Buffer buffer(*backend, {"words", 10, 4});
  std::vector<std::byte> bytes(41);
  EXPECT_THROW(backend->upload(buffer.id(), bytes), std::logic_error);
  EXPECT_THROW(backend->download(buffer.id(), bytes), std::logic_error);
  bytes.resize(4);
  EXPECT_THROW(backend->upload(buffer.id(), bytes, 37), std::logic_error);
  EXPECT_THROW(backend->upload(buffer.id(), bytes, ~uint64_t(0) - 1), std::logic_error);
  EXPECT_THROW(backend->desc(buffer.id() + 1), std::logic_error);
  EXPECT_NO_THROW(backend->upload(buffer.id(), bytes, 36));
  backend->finish();
}

TEST_P(BackendBuffers, KeepTheOrderOfUploadsAndPasses) {
  const auto backend = make();
  const uint32_t count = 5000;
  const render::Buffer from(*backend, {"from", count, 4});
  const render::Buffer first(*backend, {"first", count, 4});
  const render::Buffer second(*backend, {"second", count, 4});
  upload_words(*backend, from.id(), std::vector<uint32_t>(count, 1));
  run_pass(*backend, copy_pass, {from.id(), first.id()}, {count}, count);
  // The first pass has not run yet, and must not see this.
  upload_words(*backend, from.id(), std::vector<uint32_t>(count, 2));
  run_pass(*backend, copy_pass, {from.id(), second.id()}, {count}, count);
  EXPECT_EQ(download_words(*backend, first.id(), count), std::vector<uint32_t>(count, 1));
  EXPECT_EQ(download_words(*backend, second.id(), count), std::vector<uint32_t>(count, 2));
  backend->finish();
}

TEST_P(BackendBuffers, MayBeDestroyedBeforeThePassesThatUseThemHaveRun) {
  const auto backend = make();
  const uint32_t count = 5000;
  const render::Buffer to(*backend, {"to", count, 4});
  {
    const render::Buffer from(*backend, {"from", count, 4});
    upload_words(*backend, from.id(), std::vector<uint32_t>(count, 7));
    run_pass(*backend, copy_pass, {from.id(), to.id()}, {count}, count);
  }
  const render::Buffer other(*backend, {"other", count, 4});
  upload_words(*backend, other.id(), std::vector<uint32_t>(count, 9));
  EXPECT_EQ(download_words(*backend, to.id(), count), std::vector<uint32_t>(count, 7));
  backend->finish();
}

TEST_P(BackendBuffers, GiveTheirMemoryBack) {
  const auto backend = make();
  const uint64_t before = backend->allocated_bytes();
  {
    const render::Buffer buffer(*backend, {"items", 1 << 20, 16});
    EXPECT_GE(backend->allocated_bytes(), before + (16 << 20));
    backend->finish();
  }
  backend->finish();
  // A batch of commands, once made, keeps its counters.
  EXPECT_LT(backend->allocated_bytes(), before + (1 << 20));
}

TEST_P(BackendBuffers, LargerThanAStagingBufferArrivesWhole) {
  const auto backend = make();
  const std::vector<uint32_t> words = counting_words((80 << 20) / 4 + 3);
  const render::Buffer buffer(*backend, {"words", words.size(), 4});
  upload_words(*backend, buffer.id(), words);
  EXPECT_EQ(download_words(*backend, buffer.id(), words.size()), words);
  backend->finish();
}

}  // namespace
}  // namespace lodestone::host
