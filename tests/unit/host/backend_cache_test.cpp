// SPDX-License-Identifier: MIT
// The pipeline cache on disk: it appears, it is read, and no damage to it does any harm.
#include <filesystem>
#include <fstream>

#include "device_fixture.h"

namespace lodestone::host {
namespace {

namespace fs = std::filesystem;

class BackendCache : public SetupTest {
 protected:
  void SetUp() override {
    SetupTest::SetUp();
    folder_ = fs::temp_directory_path() /
              ("lodestone_cache_" + std::string(GetParam().name) + std::to_string(getpid()));
    fs::remove_all(folder_);
  }
  void TearDown() override {
    fs::remove_all(folder_);
    SetupTest::TearDown();
  }

  void render_once() const {
    HostOptions options = host_options();
    options.cache_folder = folder_;
    const auto backend = make(options);
    const render::Buffer values(*backend, {"values", 100, 4});
    run_pass(*backend, add_pass, {values.id()}, {100u, 3u}, 100);
    EXPECT_EQ(download_words(*backend, values.id(), 100), std::vector<uint32_t>(100, 3));
    backend->finish();
  }

  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder_, error)) found.push_back(entry.path());
    return found;
  }

  fs::path folder_;
};
INSTANTIATE_TEST_SUITE_P(Devices, BackendCache, all_setups, setup_name);

TEST_P(BackendCache, IsOneFileThatTheNextRunUses) {
  render_once();
  ASSERT_EQ(files().size(), 1u);
  const fs::path file = files().front();
  EXPECT_GT(fs::file_size(file), 0u);
  render_once();
  EXPECT_EQ(files(), std::vector<fs::path>{file});
}

TEST_P(BackendCache, IsReplacedWhereItIsDamaged) {
  render_once();
  const fs::path file = files().at(0);
  const uintmax_t whole = fs::file_size(file);
  for (const uintmax_t size : {uintmax_t(0), uintmax_t(10), whole - 1}) {
    fs::resize_file(file, size);
    render_once();
    EXPECT_EQ(fs::file_size(file), whole);
  }
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(std::streamoff(whole) - 4)
      .write("abcd", 4);
  render_once();
  EXPECT_EQ(fs::file_size(file), whole);
}

TEST_P(BackendCache, ThatCannotBeWrittenIsDoneWithout) {
  std::ofstream(folder_) << "a file where the folder should be";
  render_once();
  EXPECT_TRUE(fs::is_regular_file(folder_));
}

}  // namespace
}  // namespace lodestone::host
