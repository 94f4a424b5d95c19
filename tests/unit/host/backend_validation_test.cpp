// SPDX-License-Identifier: MIT
// That validation is silent is a condition of every test of the back end; here is that it is not deaf.
#include "device_fixture.h"
#include "lodestone/base/error.h"

namespace lodestone::host {
namespace {

class BackendValidation : public DeviceTest {
 protected:
  void SetUp() override { use_driver(Driver::lavapipe); }

  static std::unique_ptr<render::Backend> make(bool validate) {
    HostOptions options = test_options();
    options.texel_buffers = TexelBuffers::never;
    render::BackendOptions backend_options;
    backend_options.validate = validate;
    return make_backend("gpu", backend_options, options);
  }

  // A pass that writes and says that it only reads, and one that reads what it wrote: no barrier comes
  // between them.
  static void race(render::Backend& backend) {
    static constexpr render::Binding bindings[] = {{"from", render::BindingKind::word, render::Access::read},
                                                   {"to", render::BindingKind::word, render::Access::read}};
    const render::PassDecl liar{"liar", "test/copy", bindings, 4, 64};
    const render::Buffer from(backend, {"from", 64, 4});
    const render::Buffer contested(backend, {"contested", 64, 4});
    const render::Buffer to(backend, {"to", 64, 4});
    run_pass(backend, liar, {from.id(), contested.id()}, {64u}, 64);
    run_pass(backend, liar, {contested.id(), to.id()}, {64u}, 64);
    backend.finish();
  }
};

TEST_F(BackendValidation, FindsAPassThatHidesItsWrites) {
  const auto backend = make(true);
  try {
    race(*backend);
    FAIL() << "the race was not found";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::device);
    EXPECT_NE(std::string(error.what()).find("SYNC-HAZARD-READ-AFTER-WRITE"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("contested"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(backend->finish()) << "messages are told once";
}

TEST_F(BackendValidation, IsNotThereUnlessAsked) {
  EXPECT_NO_THROW(race(*make(false)));
}

TEST_F(BackendValidation, CountsEveryMessageButTheLoadersOwn) {
  MessageLog log;
  const VkDebugUtilsMessengerCreateInfoEXT info = log.messenger_info();
  VkDebugUtilsMessengerCallbackDataEXT data{};
  data.pMessageIdName = "Loader Message";
  data.pMessage = "a driver could not be loaded";
  const auto send = [&](VkDebugUtilsMessageTypeFlagsEXT type) {
    info.pfnUserCallback(VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT, type, &data, info.pUserData);
  };
  send(VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT);
  EXPECT_TRUE(log.take().empty()) << "the loader's own messages do not count";
  data.pMessageIdName = "VUID-1";
  data.pMessage = "a buffer was not destroyed";
  send(VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT);
  EXPECT_EQ(log.take(), std::vector<std::string>{"a buffer was not destroyed"});
  EXPECT_TRUE(log.take().empty());
}

}  // namespace
}  // namespace lodestone::host
