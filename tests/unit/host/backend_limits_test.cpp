// SPDX-License-Identifier: MIT
// What a user is told when the device, or what is asked of it, will not do.
#include "device_fixture.h"
#include "lodestone/base/error.h"
#include "lodestone/host/device_list.h"

namespace lodestone::host {
namespace {

class BackendLimits : public DeviceTest {
 protected:
  std::unique_ptr<render::Backend> make(TexelBuffers texel_buffers) const {
    HostOptions options = test_options();
    options.texel_buffers = texel_buffers;
    render::BackendOptions backend_options;
    backend_options.validate = true;
    return make_backend("gpu", backend_options, options);
  }
};

// The message of the Error(device) that `call` throws.
template <class Call>
std::string device_error(Call call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::device);
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in \"" << text << "\"";
}

TEST_F(BackendLimits, ABufferTooLargeIsNamedWithWhatItNeedsAndWhatIsPossible) {
  use_driver(Driver::lavapipe);
  const auto backend = make(TexelBuffers::never);
  const std::string message = device_error([&] {
    backend->create({"materials", (uint64_t(1) << 22) + 1, 32});
  });
  expect_contains(message, "materials");
  expect_contains(message, "4194305 x 32");
  expect_contains(message, "134217728");
  const std::string absurd = device_error([&] { backend->create({"absurd", ~uint64_t(0), 16}); });
  expect_contains(absurd, "absurd");
  backend->finish();
}

TEST_F(BackendLimits, WordsAndQuadsMayBeLargerThanAnyBuffer) {
  use_driver(Driver::lavapipe);
  HostOptions options = test_options();
  options.max_buffer_bytes = 3 << 20;  // in segments of 2 MiB, then
  const auto backend = make_backend("gpu", {.validate = true}, options);
  const uint32_t count = (5u << 20) / 4;
  const render::Buffer values(*backend, {"values", count, 4});
  run_pass(*backend, add_pass, {values.id()}, {count, 41u}, count);
  run_pass(*backend, add_pass, {values.id()}, {count, 1u}, count);
  EXPECT_EQ(download_words(*backend, values.id(), count), std::vector<uint32_t>(count, 42));
  backend->finish();
}

TEST_F(BackendLimits, TexelBuffersMayBeLargerThanAStorageBufferRange) {
  use_driver(Driver::lavapipe);
  const auto backend = make(TexelBuffers::automatic);
  // Words beyond 128 MiB, written and read back by a kernel.
  const uint32_t count = (160u << 20) / 4;
  const render::Buffer values(*backend, {"values", count, 4});
  run_pass(*backend, add_pass, {values.id()}, {count, 41u}, count);
  run_pass(*backend, add_pass, {values.id()}, {count, 1u}, count);
  EXPECT_EQ(download_words(*backend, values.id(), count), std::vector<uint32_t>(count, 42));
  backend->finish();
}

TEST_F(BackendLimits, ALargeTexelBufferCannotBeBoundAsStructs) {
  use_driver(Driver::lavapipe);
  const auto backend = make(TexelBuffers::automatic);
  static constexpr render::Binding bindings[] = {
      {"values", render::BindingKind::structs, render::Access::read_write}};
  const render::PassDecl pass{"add", "test/add", bindings, 8, 64};
  const uint32_t count = (160u << 20) / 4;
  const render::Buffer values(*backend, {"values", count, 4});
  const std::string message = device_error([&] {
    run_pass(*backend, pass, {values.id()}, {count, 1u}, count);
  });
  expect_contains(message, "buffer values has 167772160 bytes");
  expect_contains(message, "134217728");
  backend->finish();
}

TEST_F(BackendLimits, AKernelThatNeedsWhatTheDeviceLacksIsRefused) {
  use_driver(Driver::swiftshader);
  if (IsSkipped()) return;
  const auto backend = make(TexelBuffers::never);
  const render::PassDecl pass{"wide", "test/int64", add_bindings, 0, 64};
  const render::Buffer values(*backend, {"values", 2, 4});
  const render::BufferId buffers[] = {values.id()};
  render::Dispatch dispatch;
  dispatch.pass = &pass;
  dispatch.buffers = buffers;
  dispatch.invocations = 1;
  expect_contains(device_error([&] { backend->run(dispatch); }), "64-bit integers");
  backend->finish();
}

TEST_F(BackendLimits, AKernelWithSixtyFourBitIntegersRunsWhereThereAreSome) {
  use_driver(Driver::lavapipe);
  const auto backend = make(TexelBuffers::automatic);
  const render::PassDecl pass{"wide", "test/int64", add_bindings, 0, 64};
  const render::Buffer values(*backend, {"values", 2, 4});
  upload_words(*backend, values.id(), {0x80000000u, 6u});
  const render::BufferId buffers[] = {values.id()};
  render::Dispatch dispatch;
  dispatch.pass = &pass;
  dispatch.buffers = buffers;
  dispatch.invocations = 1;
  backend->run(dispatch);
  EXPECT_EQ(download_words(*backend, values.id(), 1).front(), 3u);
  backend->finish();
}

TEST_F(BackendLimits, TheListOfDevicesTellsWhatEachLacks) {
  use_driver(Driver::lavapipe);
  const std::vector<DeviceDetails> devices = list_devices();
  ASSERT_EQ(devices.size(), 1u);
  EXPECT_EQ(devices[0].kind, "gpu");
  expect_contains(devices[0].name, "llvmpipe");
  expect_contains(devices[0].driver, "Mesa");
  EXPECT_EQ(devices[0].subgroup_size, 8u);
  EXPECT_TRUE(devices[0].cuts_loops);
  EXPECT_TRUE(devices[0].unusable.empty());
  EXPECT_EQ(devices[0].max_buffer_bytes, uint64_t(512) << 20);
  EXPECT_FALSE(devices[0].lacks.empty());
  EXPECT_FALSE(devices[0].properties.empty());
}

TEST_F(BackendLimits, ADeviceIsChosenByIndexOrByAPartOfItsName) {
  use_driver(Driver::lavapipe);
  const std::vector<DeviceDetails> devices = list_devices();
  EXPECT_EQ(select_device(devices, "gpu"), 0u);
  EXPECT_EQ(select_device(devices, "0"), 0u);
  EXPECT_EQ(select_device(devices, "LLVMpipe"), 0u);
  for (const char* wrong : {"1", "99999999999999", "GeForce"}) {
    const std::string message = device_error([&] { select_device(devices, wrong); });
    expect_contains(message, wrong);
    expect_contains(message, "0: llvmpipe");
    expect_contains(message, "lvp_icd.x86_64.json");
  }
}

TEST_F(BackendLimits, AnUnusableDeviceIsPassedOverOrNamedWithWhatItLacks) {
  std::vector<DeviceDetails> devices(2);
  devices[0].name = "Old One";
  devices[0].unusable = {"Vulkan 1.2", "scalar block layout"};
  devices[1].name = "New One";
  devices[1].index = 1;
  EXPECT_EQ(select_device(devices, "gpu"), 1u);
  EXPECT_EQ(select_device(devices, "one"), 1u);
  expect_contains(device_error([&] { select_device(devices, "old"); }),
                  "it lacks Vulkan 1.2, scalar block layout");
}

TEST_F(BackendLimits, WithoutADriverTheFilesThatWereTriedAreNamed) {
  setenv("VK_DRIVER_FILES", "/nowhere/driver.json", 1);
  EXPECT_TRUE(list_devices().empty());
  const std::string message = device_error([] { make_backend("gpu", {}); });
  expect_contains(message, "/nowhere/driver.json (does not exist)");
  expect_contains(message, "VK_DRIVER_FILES");
}

}  // namespace
}  // namespace lodestone::host
