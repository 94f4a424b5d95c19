// SPDX-License-Identifier: MIT
// A GLB that ends early, or has bytes flipped.
#include <gtest/gtest.h>

#include <random>

#include "gltf_hostile.h"
#include "lodestone/scene/load.h"

namespace lodestone::scene {
namespace {

// A bit of everything: morph targets, a skin, an animation, an image, a material, a camera.
std::string rich_glb() {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  json& primitive = gltf.primitive(mesh);
  primitive["attributes"]["JOINTS_0"] = gltf.accessor<uint8_t>(std::vector<uint8_t>(12), "VEC4", u8);
  primitive["attributes"]["WEIGHTS_0"] = gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  primitive["indices"] = gltf.indices({0, 1, 2});
  primitive["targets"] = {{{"POSITION", gltf.floats({0, 0, 1, 0, 0, 0, 0, 0, 1}, "VEC3")}}};
  primitive["material"] = gltf.append("materials", {{"emissiveTexture", {{"index", 0}}}});
  gltf.append("textures", {{"source", 0}});
  gltf.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
  gltf.append("nodes", {{"camera", 0}});
  gltf.append("skins", {{"joints", {1}}});
  gltf.root["nodes"][0]["skin"] = 0;
  const json sampler = {{"input", gltf.floats({0, 1}, "SCALAR")}, {"output", gltf.floats({0, 1}, "SCALAR")}};
  gltf.append("animations",
              {{"samplers", {sampler}},
               {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  gltf.append("images", {{"mimeType", "image/png"},
                         {"bufferView", gltf.view_bytes(make_png(4, 4, 3, std::vector<uint8_t>(48, 9)))}});
  return gltf.glb();
}

TEST(GltfTruncated, AtEverySixteenthByteIsAnError) {
  const std::string whole = rich_glb();
  const TemporaryFolder folder;
  EXPECT_NO_THROW(load_checked(folder.write("scene.glb", whole)));
  for (size_t size = 0; size < whole.size(); size += 16) {
    SCOPED_TRACE(fmt::format("{} of {} bytes", size, whole.size()));
    expect_refused(folder.write("scene.glb", whole.substr(0, size)));
  }
}

// The length in the header is made to fit, so that the cut is only seen further in.
TEST(GltfTruncated, WithAFittingHeaderIsAnErrorToo) {
  const std::string whole = rich_glb();
  const TemporaryFolder folder;
  for (size_t size = 12; size < whole.size(); size += 16) {
    SCOPED_TRACE(fmt::format("{} of {} bytes", size, whole.size()));
    std::string cut = whole.substr(0, size);
    const uint32_t length = uint32_t(size);
    std::memcpy(&cut[8], &length, sizeof length);
    expect_refused(folder.write("scene.glb", cut));
  }
}

TEST(GltfTruncated, EveryTruncationOfTheJsonIsAnError) {
  const std::string whole = rich_glb();
  uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, &whole[12], sizeof json_bytes);
  const std::string text = whole.substr(20, json_bytes), binary = whole.substr(28 + json_bytes);
  const TemporaryFolder folder;
  const size_t end = text.rfind('}');
  for (size_t size = 0; size <= end; size += 7) {
    SCOPED_TRACE(fmt::format("{} of {} characters", size, text.size()));
    expect_refused(folder.write("scene.glb", make_glb(text.substr(0, size), binary)));
  }
}

// Whatever the bytes, the loader gives a valid scene or Error(bad_input), never anything else.
TEST(GltfTruncated, FlippedBytesNeverDoMoreThanFail) {
  const std::string whole = rich_glb();
  const TemporaryFolder folder;
  std::mt19937 random(1);
  size_t loaded = 0, refused = 0;
  for (int round = 0; round < 1000; ++round) {
    std::string changed = whole;
    for (int flips = 1 + round % 4; flips > 0; --flips) changed[random() % changed.size()] = char(random());
    const std::filesystem::path path = folder.write("scene.glb", changed);
    reset_peak();
    const size_t held = current_allocation();
    try {
      load_checked(path);
      ++loaded;
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ExitCode::bad_input) << error.what();
      ++refused;
    }
    ASSERT_LT(peak_allocation() - held, max_hostile_bytes);
  }
  EXPECT_GT(loaded, 0u);
  EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace lodestone::scene
