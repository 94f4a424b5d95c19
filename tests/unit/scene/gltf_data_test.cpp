// SPDX-License-Identifier: MIT
// The real models beside the repository load with the sizes that their README states.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "gltf_builder.h"
#include "lodestone/scene/pose.h"

namespace lodestone::scene {
namespace {

namespace fs = std::filesystem;

struct Expected {
  const char* file;
  size_t triangles, vertices, meshes, targets, joints, animations, materials, images;
};

void PrintTo(const Expected& expected, std::ostream* out) {
  *out << expected.file;
}

fs::path data_folder() {
  const char* given = std::getenv("LODESTONE_DATA");
  return given != nullptr ? fs::path(given) : fs::path(LODESTONE_SOURCE_DIR) / "../shared/data";
}

size_t joint_count(const Scene& scene) {
  size_t count = 0;
  for (const Skin& skin : scene.skins) count += skin.joints.size();
  return count;
}

class SharedModel : public testing::TestWithParam<Expected> {};

TEST_P(SharedModel, LoadsWithTheSizesOfTheReadme) {
  const fs::path path = data_folder() / GetParam().file;
  if (!fs::exists(path))
    GTEST_SKIP() << path << " is not here; set LODESTONE_DATA to the folder of the models";
  const Scene scene = load_checked(path);
  size_t triangles = 0, vertices = 0, targets = 0;
  for (const Mesh& mesh : scene.meshes) {
    triangles += mesh.triangles.size();
    vertices += mesh.positions.size();
    targets += mesh.targets.size();
  }
  EXPECT_EQ(triangles, GetParam().triangles);
  EXPECT_EQ(vertices, GetParam().vertices);
  EXPECT_EQ(targets, GetParam().targets);
  EXPECT_EQ(joint_count(scene), GetParam().joints);
  EXPECT_EQ(scene.meshes.size(), GetParam().meshes);
  EXPECT_EQ(scene.animations.size(), GetParam().animations);
  EXPECT_EQ(scene.materials.size(), GetParam().materials);
  EXPECT_EQ(scene.images.size(), GetParam().images);
}

TEST_P(SharedModel, HasFiniteBoundsOverItsFirstClip) {
  const fs::path path = data_folder() / GetParam().file;
  if (!fs::exists(path))
    GTEST_SKIP() << path << " is not here; set LODESTONE_DATA to the folder of the models";
  const Scene scene = load_checked(path);
  const Bounds rest = pose_bounds(scene, evaluate(scene, none, 0));
  const uint32_t clip = find_animation(scene, "");
  const float duration = clip == none ? 0 : scene.animations[clip].duration();
  Bounds moved;
  for (int i = 0; i <= 8; ++i)
    moved.include(pose_bounds(scene, evaluate(scene, clip, duration * float(i) / 8)));
  ASSERT_FALSE(rest.empty);
  ASSERT_FALSE(moved.empty);
  EXPECT_GT(glm::length(rest.hi - rest.lo), 0);
  // No clip of these models leaves its place by more than a few times its size.
  EXPECT_LT(glm::length(moved.hi - moved.lo), 4 * glm::length(rest.hi - rest.lo));
}

std::string name_of(const testing::TestParamInfo<Expected>& tested) {
  const std::string name = fs::path(tested.param.file).stem().string();
  if (name == "scene") return "VivaBalloon";
  return name[0] == '2' ? "TwoCylinderEngine" : name;
}

INSTANTIATE_TEST_SUITE_P(
    Gltf, SharedModel,
    testing::Values(Expected{"AnimatedMorphCube.glb", 12, 24, 1, 2, 0, 1, 1, 0},
                    Expected{"MorphStressTest.glb", 2412, 1528, 1, 8, 0, 3, 2, 3},
                    Expected{"RobotExpressive.glb", 3237, 7214, 14, 3, 86, 14, 3, 0},
                    Expected{"ict_face_sparse.glb", 52220, 28911, 1, 57, 0, 4, 12, 0},
                    Expected{"ict_face_dense16.glb", 18460, 9547, 1, 16, 0, 4, 1, 0},
                    Expected{"CesiumMan.glb", 4672, 3273, 1, 0, 19, 1, 1, 1},
                    Expected{"Fox.glb", 576, 1728, 1, 0, 24, 3, 1, 1},
                    Expected{"scallop.glb", 120000, 60002, 1, 0, 0, 0, 1, 0},
                    Expected{"2CylinderEngine.glb", 75730, 55843, 29, 0, 0, 0, 34, 0},
                    Expected{"FlightHelmet/FlightHelmet.gltf", 94722, 55392, 6, 0, 0, 0, 6, 15},
                    Expected{"VivaBalloon/scene.gltf", 35698, 25027, 37, 0, 0, 0, 37, 17}),
    name_of);

TEST(SharedModels, EngineDrawsItsMeshesAsOftenAsItsNodesPlaceThem) {
  const fs::path path = data_folder() / "2CylinderEngine.glb";
  if (!fs::exists(path))
    GTEST_SKIP() << path << " is not here; set LODESTONE_DATA to the folder of the models";
  const Scene scene = load_checked(path);
  size_t drawn = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh != none) drawn += scene.meshes[node.mesh].triangles.size();
  }
  EXPECT_EQ(drawn, 121496u);
}

TEST(SharedModels, SparseFaceMovesFewVerticesAShape) {
  const fs::path path = data_folder() / "ict_face_sparse.glb";
  if (!fs::exists(path))
    GTEST_SKIP() << path << " is not here; set LODESTONE_DATA to the folder of the models";
  const Scene scene = load_checked(path);
  const Mesh& face = scene.meshes.at(0);
  for (const MorphTarget& target : face.targets) {
    EXPECT_FALSE(target.vertices.empty()) << target.name;
    EXPECT_LT(target.vertices.size(), face.positions.size()) << target.name;
    EXPECT_FALSE(target.name.starts_with("target")) << "names come from extras";
  }
}

}  // namespace
}  // namespace lodestone::scene
