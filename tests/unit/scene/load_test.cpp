// SPDX-License-Identifier: MIT
#include "lodestone/scene/load.h"

#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace lodestone::scene {
namespace {

ExitCode code_of(const std::string& spec) {
  try {
    load(spec);
  } catch (const Error& error) {
    return error.code();
  }
  return ExitCode::done;
}

TEST(Load, ChoosesTheLoaderByExtensionAndNamesTheScene) {
  GltfBuilder gltf;
  gltf.triangle_mesh();
  for (const char* name : {"scene.glb", "scene.GLB"}) {
    const std::string path = gltf.folder().write(name, gltf.glb()).string();
    const Scene scene = load(path);
    EXPECT_EQ(scene.name, path);
    EXPECT_EQ(scene.meshes.size(), 1u);
  }
  const std::string text = gltf.folder().write("scene.gltf", gltf.gltf_embedded()).string();
  EXPECT_EQ(load(text).meshes.size(), 1u);
}

TEST(Load, EveryBuiltinIsValidAndNamed) {
  for (const std::string& name : builtin_names()) {
    const Scene scene = load("builtin:" + name);
    EXPECT_EQ(scene.name, "builtin:" + name);
    EXPECT_FALSE(scene.meshes.empty()) << name;
  }
}

TEST(Load, UnknownTypesAndBuiltinsAreUsageErrors) {
  EXPECT_EQ(code_of("scene.blend"), ExitCode::usage);
  EXPECT_EQ(code_of("scene"), ExitCode::usage);
  EXPECT_EQ(code_of("builtin:no-such-scene"), ExitCode::usage);
  EXPECT_EQ(code_of("/nowhere/scene.glb"), ExitCode::bad_input);
}

}  // namespace
}  // namespace lodestone::scene
