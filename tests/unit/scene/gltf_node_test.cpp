// SPDX-License-Identifier: MIT
// Nodes, scenes, cameras and lights.
#include <gtest/gtest.h>

#include "gltf_builder.h"
#include "lodestone/scene/pose.h"

namespace lodestone::scene {
namespace {

const Node& node_called(const Scene& scene, const std::string& name) {
  for (const Node& node : scene.nodes) {
    if (node.name == name) return node;
  }
  throw std::runtime_error("no node " + name);
}

TEST(GltfNode, ParentsComeBeforeTheirChildren) {
  GltfBuilder gltf;
  gltf.append("nodes", {{"name", "leaf"}});
  gltf.append("nodes", {{"name", "middle"}, {"children", {0}}});
  gltf.append("nodes", {{"name", "root"}, {"children", {3, 1}}});
  gltf.append("nodes", {{"name", "other"}});
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.nodes.size(), 4u);
  for (uint32_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(scene.nodes[i].parent == none || scene.nodes[i].parent < i) << i;
  }
  EXPECT_EQ(scene.nodes.at(node_called(scene, "leaf").parent).name, "middle");
  EXPECT_EQ(scene.nodes.at(node_called(scene, "middle").parent).name, "root");
  EXPECT_EQ(scene.nodes.at(node_called(scene, "other").parent).name, "root");
}

TEST(GltfNode, ReferencesFollowTheNewOrder) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.primitive(mesh)["attributes"]["JOINTS_0"] =
      gltf.accessor<uint8_t>(std::vector<uint8_t>(12), "VEC4", u8);
  gltf.primitive(mesh)["attributes"]["WEIGHTS_0"] = gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  gltf.append("nodes", {{"name", "joint"}});
  gltf.append("nodes", {{"name", "root"}, {"children", {1, 0}}});
  gltf.append("skins", {{"joints", {1}}});
  gltf.root["nodes"][0]["skin"] = 0;
  const json sampler = {{"input", gltf.floats({0}, "SCALAR")}, {"output", gltf.floats({1, 2, 3}, "VEC3")}};
  gltf.append("animations",
              {{"samplers", {sampler}},
               {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
  const Scene scene = gltf.load();
  EXPECT_EQ(scene.nodes.at(scene.skins.at(0).joints.at(0)).name, "joint");
  EXPECT_EQ(scene.nodes.at(scene.animations.at(0).channels.at(0).node).name, "joint");
}

json instancing(GltfBuilder& gltf, const json& attributes) {
  gltf.triangle_mesh();
  const json extension = {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}};
  gltf.append("nodes", {{"mesh", 0}, {"translation", {10, 0, 0}}, {"extensions", extension}});
  gltf.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  gltf.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  return gltf.root;
}

TEST(GltfNode, InstancesBecomeChildrenWithTheMesh) {
  GltfBuilder gltf;
  const int at = gltf.floats({1, 2, 3, 4, 5, 6}, "VEC3"),
            turn = gltf.floats({0, 0, 1, 1, 0, 0, 0, 2}, "VEC4");
  instancing(gltf, {{"TRANSLATION", at}, {"ROTATION", turn}});
  gltf.root["nodes"].erase(0);  // the builder's own
  gltf.root["scenes"] = json::array({{{"nodes", {0}}}});
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.nodes.size(), 3u);
  EXPECT_EQ(scene.nodes[0].mesh, none);
  for (uint32_t i = 1; i < 3; ++i) {
    EXPECT_EQ(scene.nodes[i].parent, 0u);
    EXPECT_EQ(scene.nodes[i].mesh, 0u);
    EXPECT_EQ(scene.nodes[i].scale, glm::vec3(1));
  }
  EXPECT_EQ(scene.nodes[2].translation, glm::vec3(4, 5, 6));
  EXPECT_NEAR(scene.nodes[1].rotation.z, 0.70710678f, 1e-6f);
  EXPECT_EQ(scene.nodes[2].rotation, glm::quat(1, 0, 0, 0));
  EXPECT_EQ(evaluate(scene, none, 0).node_world[2][3], glm::vec4(14, 5, 6, 1));
}

TEST(GltfNode, InstancesThatCannotBeAreRefused) {
  const auto refused = [](const auto& attributes_of, const std::string& because) {
    GltfBuilder gltf;
    instancing(gltf, attributes_of(gltf));
    const std::string message = expect_bad_input(gltf.folder().write("s.glb", gltf.glb()));
    EXPECT_NE(message.find(because), std::string::npos) << message;
  };
  refused([](GltfBuilder&) { return json::object(); }, "TRANSLATION, ROTATION or SCALE");
  refused(
      [](GltfBuilder& gltf) {
        const int two = gltf.floats({1, 2, 3, 4, 5, 6}, "VEC3"), one = gltf.floats({1, 1, 1}, "VEC3");
        return json{{"TRANSLATION", two}, {"SCALE", one}};
      },
      "2 and 1 elements");
  refused(
      [](GltfBuilder& gltf) {
        return json{{"ROTATION", gltf.floats({0, 0, 0, 0}, "VEC4")}};
      },
      "length 0");
  refused([](GltfBuilder&) { return json{{"SCALE", 99}}; }, "99");
  refused([](GltfBuilder&) { return json{{"SCALE", "2"}}; }, "an index");
}

TEST(GltfNode, OnlyTheDefaultSceneIsDrawn) {
  GltfBuilder gltf;
  gltf.triangle_mesh();
  gltf.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
  gltf.append("nodes", {{"name", "hidden"}, {"mesh", 0}, {"camera", 0}});
  gltf.append("nodes", {{"name", "parent"}, {"children", {0}}});
  gltf.append("scenes", {{"nodes", {1}}});
  gltf.append("scenes", {{"nodes", {2}}});
  gltf.root["scene"] = 1;
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.nodes.size(), 3u) << "the others stay, joints may be among them";
  EXPECT_EQ(node_called(scene, "hidden").mesh, none);
  EXPECT_EQ(node_called(scene, "hidden").camera, none);
  EXPECT_EQ(node_called(scene, "").mesh, 0u) << "children of a drawn node are drawn";
}

TEST(GltfNode, WithoutADefaultTheFirstSceneIsDrawnAndWithoutScenesAll) {
  GltfBuilder gltf;
  gltf.triangle_mesh();
  gltf.append("nodes", {{"name", "second"}, {"mesh", 0}});
  EXPECT_EQ(node_called(gltf.load(), "second").mesh, 0u);
  gltf.append("scenes", {{"nodes", {0}}});
  EXPECT_EQ(node_called(gltf.load(), "second").mesh, none);
}

TEST(GltfNode, ReadsMatrixOrTranslationRotationScale) {
  GltfBuilder gltf;
  gltf.append("nodes", {{"translation", {1, 2, 3}}, {"rotation", {0, 0, 2, 0}}, {"scale", {4, 5, 6}}});
  gltf.append("nodes", {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}}});
  const Scene scene = gltf.load();
  EXPECT_EQ(scene.nodes[0].translation, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.nodes[0].rotation, glm::quat(0, 0, 0, 1)) << "unit length";
  EXPECT_EQ(scene.nodes[0].scale, glm::vec3(4, 5, 6));
  EXPECT_FALSE(scene.nodes[0].matrix);
  ASSERT_TRUE(scene.nodes[1].matrix);
  EXPECT_EQ((*scene.nodes[1].matrix)[3], glm::vec4(7, 8, 9, 1));
  // (1, 0, 0) scaled to (4, 0, 0), turned half around z, moved.
  const glm::vec4 p = evaluate(scene, none, 0).node_world[0] * glm::vec4(1, 0, 0, 1);
  EXPECT_EQ(p, glm::vec4(-3, 2, 3, 1));
}

TEST(GltfNode, TenThousandLevelsDeepLoads) {
  GltfBuilder gltf;
  json nodes = json::array();
  for (int i = 0; i < 10000; ++i) nodes.push_back({{"translation", {1, 0, 0}}, {"children", {i + 1}}});
  nodes.push_back(json::object());
  gltf.root["nodes"] = nodes;
  const Scene scene = gltf.load();
  EXPECT_EQ(evaluate(scene, none, 0).node_world.back()[3].x, 10000);
}

TEST(GltfNode, OwnWeightsReplaceThoseOfTheMesh) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.primitive(mesh)["targets"] = {{{"POSITION", gltf.floats(std::vector<float>(9, 1), "VEC3")}}};
  gltf.root["meshes"][0]["weights"] = {0.25};
  gltf.append("nodes", {{"mesh", 0}, {"weights", {0.75}}});
  const Scene scene = gltf.load();
  const Pose pose = evaluate(scene, none, 0);
  EXPECT_EQ(pose.weights.at(0), std::vector<float>{0.25f});
  EXPECT_EQ(pose.weights.at(1), std::vector<float>{0.75f});
}

TEST(GltfCamera, ReadsBothProjections) {
  GltfBuilder gltf;
  gltf.append("cameras", {{"name", "lens"},
                          {"type", "perspective"},
                          {"perspective", {{"yfov", 0.5}, {"znear", 0.25}, {"aspectRatio", 1.5}}}});
  gltf.append("cameras", {{"type", "orthographic"},
                          {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 100}}}});
  gltf.append("nodes", {{"camera", 1}});
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_TRUE(scene.cameras[0].perspective);
  EXPECT_EQ(scene.cameras[0].name, "lens");
  EXPECT_EQ(scene.cameras[0].yfov, 0.5f);
  EXPECT_EQ(scene.cameras[0].znear, 0.25f);
  EXPECT_EQ(scene.cameras[0].aspect, 1.5f);
  EXPECT_EQ(scene.cameras[0].zfar, 0) << "infinite";
  EXPECT_FALSE(scene.cameras[1].perspective);
  EXPECT_EQ(scene.cameras[1].xmag, 3);
  EXPECT_EQ(scene.cameras[1].ymag, 2);
  EXPECT_EQ(scene.cameras[1].zfar, 100);
  EXPECT_EQ(scene.nodes.at(0).camera, 1u);
}

TEST(GltfLight, ReadsPunctualLights) {
  GltfBuilder gltf;
  gltf.root["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0.25}}},
      {{"type", "point"}, {"range", 9}},
      {{"type", "spot"}, {"name", "lamp"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}};
  gltf.append("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 2}}}}}});
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].kind, Light::Kind::directional);
  EXPECT_EQ(scene.lights[0].intensity, 3);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(scene.lights[1].kind, Light::Kind::point);
  EXPECT_EQ(scene.lights[1].range, 9);
  EXPECT_EQ(scene.lights[1].intensity, 1);
  EXPECT_EQ(scene.lights[1].color, glm::vec3(1));
  EXPECT_EQ(scene.lights[2].kind, Light::Kind::spot);
  EXPECT_EQ(scene.lights[2].inner_cone, 0.25f);
  EXPECT_EQ(scene.lights[2].outer_cone, 0.5f);
  EXPECT_EQ(scene.nodes.at(0).light, 2u);
}

TEST(GltfLight, ASpotMayHaveAHardEdge) {
  GltfBuilder gltf;
  gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}}};
  EXPECT_EQ(gltf.load().lights.at(0).inner_cone, 0.5f);
}

TEST(GltfLight, NumbersThatAreNoneAreErrors) {
  for (const char* light :
       {R"({"type": "point", "intensity": "3"})", R"({"type": "point", "color": [1, "1", 1]})",
        R"({"type": "spot", "spot": {"outerConeAngle": true}})"}) {
    GltfBuilder gltf;
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({json::parse(light)});
    const std::string message = expect_bad_input(gltf.folder().write("s.glb", gltf.glb()));
    EXPECT_NE(message.find("lights[0]"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace lodestone::scene
