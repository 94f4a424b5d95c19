// SPDX-License-Identifier: MIT
#include "lodestone/scene/asset_folder.h"

#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace lodestone::scene {
namespace {

namespace fs = std::filesystem;

TEST(AssetFolder, FindsFilesBesideAndBelowTheScene) {
  const TemporaryFolder folder;
  const AssetFolder assets(folder.write("scene.obj", ""));
  const fs::path beside = folder.write("a.png", "x"), below = folder.write("maps/b.png", "x");
  EXPECT_EQ(assets.find("a.png"), fs::canonical(beside));
  EXPECT_EQ(assets.find("./a.png"), fs::canonical(beside));
  EXPECT_EQ(assets.find("maps/b.png"), fs::canonical(below));
  EXPECT_EQ(assets.find("maps\\b.png"), fs::canonical(below)) << "as written on Windows";
}

TEST(AssetFolder, LeavesItByNoWay) {
  const TemporaryFolder outside, folder;
  const fs::path secret = outside.write("secret", "x");
  fs::create_symlink(secret, folder.path() / "link");
  fs::create_directory_symlink(outside.path(), folder.path() / "door");
  // A folder whose name only begins like ours is outside as well.
  const fs::path sibling = folder.path().string() + "-sibling";
  fs::create_directories(sibling);
  const AssetFolder assets(folder.write("scene.obj", ""));
  for (const std::string& name :
       {secret.string(), std::string("../") + outside.path().filename().string() + "/secret",
        std::string("link"), std::string("door/secret"), std::string(".."), std::string("a/../../x"),
        std::string("C:\\x"), std::string(), std::string("missing"), std::string("."),
        std::string("scene.obj\0x", 11)}) {
    EXPECT_THROW(assets.find(name), Error) << name;
  }
  fs::remove_all(sibling);
}

TEST(AssetFolder, ErrorsNameTheSceneAndShortenTheFile) {
  const TemporaryFolder folder;
  const fs::path scene = folder.write("scene.obj", "");
  try {
    AssetFolder(scene).find(std::string(5000, 'a') + "\n");
    FAIL() << "found";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_TRUE(message.starts_with(scene.string() + ": ")) << message;
    EXPECT_LT(message.size(), 400u);
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace lodestone::scene
