// SPDX-License-Identifier: MIT
// Passes of the Vulkan back end: order, constants, counters, times.
#include <array>
#include <chrono>
#include <cmath>

#include "device_fixture.h"

namespace lodestone::host {
namespace {

class BackendPasses : public SetupTest {};
INSTANTIATE_TEST_SUITE_P(Devices, BackendPasses, all_setups, setup_name);

void run_count(render::Backend& backend, uint32_t count) {
  static constexpr render::PassDecl pass{"count", "test/count", {}, 4, 64};
  render::Dispatch dispatch;
  dispatch.pass = &pass;
  dispatch.push = std::as_bytes(std::span(&count, 1));
  dispatch.invocations = count;
  backend.run(dispatch);
}

constexpr render::Binding result_bindings[] = {{"results", render::BindingKind::word, render::Access::write}};

TEST_P(BackendPasses, SeeWhatThePassesBeforeThemWrote) {
  HostOptions options = host_options();
  options.passes_per_batch = 7;  // chains must hold across batches
  const auto backend = make(options);
  const uint32_t count = 1000;
  const render::Buffer a(*backend, {"a", count, 4});
  const render::Buffer b(*backend, {"b", count, 4});
  for (uint32_t i = 0; i < 40; ++i) {
    run_pass(*backend, add_pass, {a.id()}, {count, 1u}, count);
    run_pass(*backend, copy_pass, {a.id(), b.id()}, {count}, count);
    run_pass(*backend, add_pass, {b.id()}, {count, 1000u}, count);
    run_pass(*backend, copy_pass, {b.id(), a.id()}, {count}, count);
  }
  EXPECT_EQ(download_words(*backend, a.id(), count), std::vector<uint32_t>(count, 40 * 1001));
  const std::vector<render::PassRecord> records = backend->finish();
  ASSERT_EQ(records.size(), 160u);
  for (size_t i = 0; i < records.size(); ++i) EXPECT_EQ(records[i].name, i % 2 == 0 ? "add" : "copy");
}

TEST_P(BackendPasses, DoNotOverwriteWhatAnEarlierPassHasYetToRead) {
  const auto backend = make();
  const uint32_t count = 60000;
  const render::Buffer a(*backend, {"a", count, 4});
  const render::Buffer b(*backend, {"b", count, 4});
  run_pass(*backend, copy_pass, {a.id(), b.id()}, {count}, count);
  run_pass(*backend, add_pass, {a.id()}, {count, 5u}, count);
  EXPECT_EQ(download_words(*backend, b.id(), count), std::vector<uint32_t>(count, 0));
  EXPECT_EQ(download_words(*backend, a.id(), count), std::vector<uint32_t>(count, 5));
  backend->finish();
}

TEST_P(BackendPasses, BindQuadsWordsAndStructs) {
  static constexpr render::Binding bindings[] = {
      {"quads", render::BindingKind::quad, render::Access::read},
      {"words", render::BindingKind::word, render::Access::read},
      {"items", render::BindingKind::structs, render::Access::read},
      {"results", render::BindingKind::quad, render::Access::write}};
  static constexpr render::PassDecl pass{"gather", "test/gather", bindings, 4, 32};
  const auto backend = make();
  const uint32_t count = 777;
  std::vector<uint32_t> quads, words, items, expected;
  for (uint32_t i = 0; i < count; ++i) {
    const std::array<uint32_t, 4> quad{i, i * 3, i * 5, i * 7};
    const std::array<uint32_t, 4> others{i * 11, i * 13, i * 17, i * 19};
    quads.insert(quads.end(), quad.begin(), quad.end());
    words.push_back(others[0]);
    items.insert(items.end(), others.begin() + 1, others.end());
    for (size_t k = 0; k < 4; ++k) expected.push_back(quad[k] + others[k]);
  }
  const render::Buffer quad_buffer(*backend, {"quads", count, 16});
  const render::Buffer word_buffer(*backend, {"words", count, 4});
  const render::Buffer item_buffer(*backend, {"items", count, 12});
  const render::Buffer results(*backend, {"results", count, 16});
  upload_words(*backend, quad_buffer.id(), quads);
  upload_words(*backend, word_buffer.id(), words);
  upload_words(*backend, item_buffer.id(), items);
  run_pass(*backend, pass, {quad_buffer.id(), word_buffer.id(), item_buffer.id(), results.id()}, {count},
           count);
  EXPECT_EQ(download_words(*backend, results.id(), expected.size()), expected);
  backend->finish();
}

TEST_P(BackendPasses, GiveKernelsTheirSpecializationConstants) {
  for (const bool counting : {false, true}) {
    const auto backend = make(counting);
    const render::Buffer results(*backend, {"results", 6, 4});
    for (const uint32_t workgroup : {8u, 128u}) {
      const render::PassDecl pass{"constants", "test/constants", result_bindings, 0, workgroup};
      const render::BufferId buffers[] = {results.id()};
      render::Dispatch dispatch;
      dispatch.pass = &pass;
      dispatch.buffers = buffers;
      dispatch.invocations = 1;
      dispatch.constants = {10, 0xffffffffu, workgroup, 13};
      backend->run(dispatch);
      const std::vector<uint32_t> expected{workgroup, counting ? 1u : 0u, 10, 0xffffffffu, workgroup, 13};
      EXPECT_EQ(download_words(*backend, results.id(), 6), expected);
    }
    backend->finish();
  }
}

TEST_P(BackendPasses, LimitTheWorkgroupToWhatTheDeviceCanDo) {
  const auto backend = make();
  const render::Buffer results(*backend, {"results", 6, 4});
  const render::PassDecl pass{"constants", "test/constants", result_bindings, 0, 1u << 20};
  const render::BufferId buffers[] = {results.id()};
  render::Dispatch dispatch;
  dispatch.pass = &pass;
  dispatch.buffers = buffers;
  dispatch.invocations = 5000;
  backend->run(dispatch);
  const uint32_t workgroup = download_words(*backend, results.id(), 1).front();
  EXPECT_EQ(workgroup, GetParam().driver == Driver::lavapipe ? 1024u : 256u);
  backend->finish();
}

TEST_P(BackendPasses, RunMoreWorkgroupsThanFitIntoARow) {
  const auto backend = make();
  const uint32_t count = 70001,
                 length = 65000;  // 70,001 workgroups of one invocation, where a row has 65,535
  const render::PassDecl pass{"add", "test/add", add_bindings, 8, 1};
  const render::Buffer values(*backend, {"values", length, 4});
  run_pass(*backend, pass, {values.id()}, {length, 3u}, count);
  EXPECT_EQ(download_words(*backend, values.id(), length), std::vector<uint32_t>(length, 3));
  backend->finish();
}

TEST_P(BackendPasses, CountForEachDispatchAlone) {
  const auto backend = make(true);
  for (const uint32_t count : {100u, 1u, 70001u}) run_count(*backend, count);
  const std::vector<render::PassRecord> records = backend->finish();
  ASSERT_EQ(records.size(), 3u);
  for (const render::PassRecord& record : records) {
    const uint64_t n = record.invocations;
    EXPECT_TRUE(record.counted);
    EXPECT_EQ(record.counters.bytes_read, n * 12);
    EXPECT_EQ(record.counters.bytes_written, n * 8);
    EXPECT_EQ(record.counters.rays, n * (n + 1) / 2 % (uint64_t(1) << 32));
    EXPECT_EQ(record.counters.node_visits, n * 2);
    EXPECT_EQ(record.counters.box_tests, n * 3);
    EXPECT_EQ(record.counters.triangle_tests, n * 4);
    EXPECT_EQ(record.counters.lane_steps, n * 5);
    EXPECT_EQ(record.counters.subgroup_steps, n * 6);
  }
}

TEST_P(BackendPasses, CountNothingUnlessAsked) {
  const auto backend = make(false);
  run_count(*backend, 100);
  const std::vector<render::PassRecord> records = backend->finish();
  ASSERT_EQ(records.size(), 1u);
  EXPECT_FALSE(records[0].counted);
  EXPECT_EQ(records[0].counters.bytes_read, 0u);
  EXPECT_EQ(records[0].counters.rays, 0u);
}

TEST_P(BackendPasses, AreTimedByTheDeviceButForTheFirstOfAKernel) {
  const auto start = std::chrono::steady_clock::now();
  const auto backend = make();
  const uint32_t count = 60000;
  const render::Buffer values(*backend, {"values", count, 4});
  for (int i = 0; i < 4; ++i) run_pass(*backend, add_pass, {values.id()}, {count, 1u}, count);
  const std::vector<render::PassRecord> records = backend->finish();
  const double elapsed =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  ASSERT_EQ(records.size(), 4u);
  double end = 0;
  for (size_t i = 0; i < records.size(); ++i) {
    EXPECT_EQ(records[i].first, i == 0);
    EXPECT_EQ(std::isnan(records[i].device_ms), i == 0);
    if (i > 0) {
      EXPECT_GT(records[i].device_ms, 0);
      EXPECT_LT(records[i].device_ms, elapsed);
    }
    // Within the life of the back end, one after the other; clocks may disagree by a little.
    EXPECT_GE(records[i].wall_start_ms, end - 1);
    EXPECT_GT(records[i].wall_ms, 0);
    end = records[i].wall_start_ms + records[i].wall_ms;
  }
  EXPECT_LE(end, elapsed + 1);
}

TEST_P(BackendPasses, EndTheirLoopsUnlessTheDeviceSaysThatItCutsThem) {
  static constexpr render::Binding bindings[] = {
      {"results", render::BindingKind::word, render::Access::read_write}};
  static constexpr render::PassDecl pass{"loop", "test/loop", bindings, 4, 1};
  const auto backend = make();
  const render::Buffer results(*backend, {"results", 2, 4});
  const uint32_t iterations = 100000;
  run_pass(*backend, pass, {results.id()}, {iterations}, 1);
  const uint32_t done = download_words(*backend, results.id(), 1).front();
  EXPECT_EQ(backend->info().cuts_loops, done != iterations) << done;
  backend->finish();
}

TEST_P(BackendPasses, NeedADispatchThatFitsTheirDeclaration) {
  const auto backend = make();
  const render::Buffer values(*backend, {"values", 10, 4});
  EXPECT_THROW(run_pass(*backend, copy_pass, {values.id()}, {10u}, 10), std::logic_error);
  EXPECT_THROW(run_pass(*backend, add_pass, {values.id()}, {10u}, 10), std::logic_error);
  const render::PassDecl unknown{"unknown", "test/unknown", add_bindings, 8, 64};
  EXPECT_THROW(run_pass(*backend, unknown, {values.id()}, {10u, 1u}, 10), std::logic_error);
  run_pass(*backend, add_pass, {values.id()}, {10u, 1u}, 10);
  EXPECT_EQ(download_words(*backend, values.id(), 10), std::vector<uint32_t>(10, 1));
  backend->finish();
}

}  // namespace
}  // namespace lodestone::host
