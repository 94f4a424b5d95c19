// SPDX-License-Identifier: MIT
// The head as one sees it from the front: what hides what in which expression.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "lodestone/scene/load.h"
#include "mesh_probe.h"

namespace lodestone {
namespace {

using scene::Scene;

class HeadFace : public testing::Test {
 protected:
  static void SetUpTestSuite() { head_ = new Scene(scene::make_builtin("head")); }
  static void TearDownTestSuite() {
    delete head_;
    head_ = nullptr;
  }
  // What one sees at (x, y) of the face, looking along -Z.
  static std::string seen(const std::string& shape, float x, float y) {
    return test::first_hit(*head_, shape, {x, y, 3}, {0, 0, -1}).mesh;
  }
  static const Scene* head_;
};
const Scene* HeadFace::head_ = nullptr;

constexpr float eye_x = 0.335f, eye_y = 0.03f;

TEST_F(HeadFace, HasTheShapesOfAFace) {
  std::set<std::string> names;
  for (const scene::Mesh& mesh : head_->meshes)
    for (const scene::MorphTarget& target : mesh.targets) names.insert(target.name);
  for (const char* name :
       {"jawOpen", "smile", "frown", "grin", "pucker", "puff", "sneer", "browUp", "browDown", "blinkLeft",
        "blinkRight", "eyesWide", "lookLeft", "lookRight", "lookUp", "lookDown", "tongueOut", "surprise"})
    EXPECT_EQ(names.count(name), 1u) << name;
}

TEST_F(HeadFace, EyesAreOpenAtRest) {
  for (const float side : {-1.0f, 1.0f})
    for (const float x : {-0.08f, 0.0f, 0.08f}) EXPECT_EQ(seen("", side * eye_x + x, eye_y), "eyes");
}

TEST_F(HeadFace, ShutLidsCoverTheWholeEye) {
  for (const auto& [shape, side] : {std::pair("blinkLeft", 1.0f), std::pair("blinkRight", -1.0f)})
    for (int y = -6; y <= 6; ++y)
      for (int x = -6; x <= 6; ++x)
        EXPECT_NE(seen(shape, side * eye_x + 0.037f * float(x), eye_y + 0.037f * float(y)), "eyes")
            << shape << " " << x << " " << y;
}

TEST_F(HeadFace, BlinkingLeavesTheOtherEyeOpen) {
  EXPECT_EQ(seen("blinkLeft", -eye_x, eye_y), "eyes");
  EXPECT_EQ(seen("blinkRight", eye_x, eye_y), "eyes");
}

TEST_F(HeadFace, ShutLipsHideTeethAndTongue) {
  for (const char* shape : {"", "smile", "frown", "pucker", "puff", "sneer", "browDown", "lookUp"})
    for (int y = -4; y <= 4; ++y)
      for (int x = -8; x <= 8; ++x) {
        const std::string mesh = seen(shape, 0.045f * float(x), -0.54f + 0.03f * float(y));
        EXPECT_EQ(mesh, "skin") << shape << " " << x << " " << y;
      }
}

TEST_F(HeadFace, GrinAndOpenJawShowTeeth) {
  for (const char* shape : {"grin", "jawOpen", "surprise"}) {
    bool teeth = false;
    for (int y = -8; y <= 4; ++y) teeth = teeth || seen(shape, 0.02f, -0.54f + 0.03f * float(y)) == "teeth";
    EXPECT_TRUE(teeth) << shape;
  }
}

TEST_F(HeadFace, TongueComesOutBetweenTheLips) {
  const test::Hit tongue = test::first_hit(*head_, "tongueOut", {0, -0.72f, 3}, {0, 0, -1});
  EXPECT_EQ(tongue.mesh, "tongue");
  EXPECT_EQ(seen("jawOpen", 0, -0.40f), "skin");
}

TEST_F(HeadFace, LooksWhereTheShapeSays) {
  // The centre of the iris is the vertex whose texture coordinates are the middle of the picture.
  const auto mesh = std::find_if(head_->meshes.begin(), head_->meshes.end(),
                                 [](const scene::Mesh& m) { return m.name == "eyes"; });
  ASSERT_NE(mesh, head_->meshes.end());
  const auto& uvs = mesh->texcoords[0];
  const auto pupil = size_t(std::find(uvs.begin(), uvs.end(), glm::vec2(0.5f)) - uvs.begin());
  ASSERT_LT(pupil, uvs.size());
  const auto moved = [&](const std::string& shape) {
    for (const scene::MorphTarget& target : mesh->targets)
      if (target.name == shape) return test::posed_positions(*mesh, target)[pupil] - mesh->positions[pupil];
    return glm::vec3(0);
  };
  EXPECT_GT(moved("lookLeft").x, 0.05f);
  EXPECT_LT(moved("lookRight").x, -0.05f);
  EXPECT_GT(moved("lookUp").y, 0.05f);
  EXPECT_LT(moved("lookDown").y, -0.05f);
}

TEST_F(HeadFace, LowerTeethFollowTheJawAndUpperOnesStay) {
  const auto mesh = std::find_if(head_->meshes.begin(), head_->meshes.end(),
                                 [](const scene::Mesh& m) { return m.name == "teeth"; });
  ASSERT_NE(mesh, head_->meshes.end());
  const std::vector<glm::vec3> posed = test::posed_positions(*mesh, mesh->targets.at(0));
  ASSERT_EQ(mesh->targets[0].name, "jawOpen");
  const size_t half = posed.size() / 2;
  for (size_t v = 0; v < half; ++v) ASSERT_EQ(posed[v], mesh->positions[v]);
  for (size_t v = half; v < posed.size(); ++v) ASSERT_LT(posed[v].y, mesh->positions[v].y - 0.05f);
}

}  // namespace
}  // namespace lodestone
