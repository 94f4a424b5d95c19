// SPDX-License-Identifier: MIT
// Tests on Vulkan devices: lavapipe always, SwiftShader where LODESTONE_SWIFTSHADER_ICD names its driver
// file.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "lodestone/host/instance.h"
#include "lodestone/host/vulkan_backend.h"

namespace lodestone::test_kernels {
std::span<const kernels::Kernel> all_kernels();
}

namespace lodestone::host {

enum class Driver { lavapipe, swiftshader };

// The driver file; none where the driver is not at hand.
inline std::optional<std::string> driver_file(Driver driver) {
  if (driver == Driver::lavapipe) return "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";
  const char* file = std::getenv("LODESTONE_SWIFTSHADER_ICD");
  return file == nullptr || *file == 0 ? std::nullopt : std::optional<std::string>(file);
}

// A driver, and the ways to hold buffers that tests should not tell apart.
struct Setup {
  const char* name;
  Driver driver;
  TexelBuffers texel_buffers;
  bool map_device_memory;
  uint64_t max_buffer_bytes = std::numeric_limits<uint64_t>::max();  // longer arrays are split
};

inline std::ostream& operator<<(std::ostream& out, const Setup& setup) {
  return out << setup.name;
}

inline const auto all_setups =
    testing::Values(Setup{"lavapipe_texel_mapped", Driver::lavapipe, TexelBuffers::always, true},
                    Setup{"lavapipe_no_pairs_mapped", Driver::lavapipe, TexelBuffers::without_pairs, true},
                    Setup{"lavapipe_plain_staged", Driver::lavapipe, TexelBuffers::never, false},
                    Setup{"lavapipe_split_mapped", Driver::lavapipe, TexelBuffers::always, true, 16384},
                    Setup{"swiftshader_split_staged", Driver::swiftshader, TexelBuffers::never, false, 20000},
                    Setup{"swiftshader_plain_mapped", Driver::swiftshader, TexelBuffers::never, true},
                    Setup{"swiftshader_texel_staged", Driver::swiftshader, TexelBuffers::always, false});

inline std::string setup_name(const testing::TestParamInfo<Setup>& info) {
  return info.param.name;
}

// Every back end is validated: a test fails where the layers have anything to say.
class DeviceTest : public testing::Test {
 protected:
  // Skips the test where the driver is not there.
  void use_driver(Driver driver) {
    const std::optional<std::string> file = driver_file(driver);
    if (!file) GTEST_SKIP() << "LODESTONE_SWIFTSHADER_ICD does not name SwiftShader's driver file";
    setenv("VK_DRIVER_FILES", file->c_str(), 1);
  }

  void TearDown() override {
    const std::vector<std::string> messages = take_late_messages();
    EXPECT_TRUE(messages.empty()) << messages.front();
  }

  static HostOptions test_options() {
    HostOptions options;
    options.kernels = test_kernels::all_kernels();
    options.cache_folder.reset();
    return options;
  }
};

class SetupTest : public DeviceTest, public testing::WithParamInterface<Setup> {
 protected:
  void SetUp() override { use_driver(GetParam().driver); }

  HostOptions host_options() const {
    HostOptions options = test_options();
    options.texel_buffers = GetParam().texel_buffers;
    options.map_device_memory = GetParam().map_device_memory;
    options.max_buffer_bytes = GetParam().max_buffer_bytes;
    return options;
  }

  std::unique_ptr<render::Backend> make(bool counters = false) const {
    return make(host_options(), counters);
  }
  static std::unique_ptr<render::Backend> make(const HostOptions& options, bool counters = false) {
    render::BackendOptions backend_options;
    backend_options.counters = counters;
    backend_options.validate = true;
    return make_backend("gpu", backend_options, options);
  }
};

// Words and back.
inline void upload_words(render::Backend& backend, render::BufferId buffer,
                         const std::vector<uint32_t>& words) {
  backend.upload(buffer, std::as_bytes(std::span(words)));
}
inline std::vector<uint32_t> download_words(render::Backend& backend, render::BufferId buffer, size_t count) {
  std::vector<uint32_t> words(count);
  backend.download(buffer, std::as_writable_bytes(std::span(words)));
  return words;
}

// A dispatch of a pass over these buffers, with push constants of words.
template <size_t Buffers, size_t Words>
void run_pass(render::Backend& backend, const render::PassDecl& pass,
              const render::BufferId (&buffers)[Buffers], const uint32_t (&push)[Words],
              uint32_t invocations) {
  render::Dispatch dispatch;
  dispatch.pass = &pass;
  dispatch.buffers = buffers;
  dispatch.push = std::as_bytes(std::span(push));
  dispatch.invocations = invocations;
  backend.run(dispatch);
}

inline constexpr render::Binding add_bindings[] = {
    {"values", render::BindingKind::word, render::Access::read_write}};
inline constexpr render::PassDecl add_pass{"add", "test/add", add_bindings, 8, 64};

inline constexpr render::Binding copy_bindings[] = {{"from", render::BindingKind::word, render::Access::read},
                                                    {"to", render::BindingKind::word, render::Access::write}};
inline constexpr render::PassDecl copy_pass{"copy", "test/copy", copy_bindings, 4, 64};

}  // namespace lodestone::host
