// SPDX-License-Identifier: MIT
#include <fstream>
#include <set>

#include "lodestone/base/file.h"
#include "sample_atlas.h"

namespace lodestone::geometry_image {
namespace {

namespace fs = std::filesystem;
using test::expect_equal;
using test::sample_scene;

// Sets or clears a variable of the environment for the length of a test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    set(value);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() { set(old_ ? old_->c_str() : nullptr); }

 private:
  void set(const char* value) const {
    if (value != nullptr) {
      ::setenv(name_, value, 1);
    } else {
      ::unsetenv(name_);
    }
  }
  const char* name_;
  std::optional<std::string> old_;
};

class Cache : public test::FolderTest {
 protected:
  // Whether the cache had it.
  bool ask(const scene::Scene& wanted) {
    const scene::Assembly assembly = scene::assemble(wanted);
    bool hit = false;
    expect_equal(cached_atlas(wanted, assembly, AtlasKind::automatic, &hit),
                 build_atlas(wanted, assembly, AtlasKind::automatic));
    return hit;
  }

  static std::vector<fs::path> files(const fs::path& in) {
    std::vector<fs::path> found;
    if (!fs::exists(in)) return found;
    for (const fs::directory_entry& entry : fs::directory_iterator(in)) found.push_back(entry.path());
    return found;
  }

  const scene::Scene scene_ = sample_scene();
};

TEST_F(Cache, FindsWhatWasBuiltBefore) {
  const Variable chosen("LODESTONE_CACHE", (folder() / "cache").c_str());
  EXPECT_FALSE(ask(scene_));
  EXPECT_TRUE(ask(scene_));
  EXPECT_EQ(files(folder() / "cache").size(), 1u);
  scene::Scene moved = scene_;
  moved.meshes[0].positions[0].x += 1;
  EXPECT_FALSE(ask(moved));
  EXPECT_TRUE(ask(scene_));
  cached_atlas(scene_, scene::assemble(scene_),
               AtlasKind::automatic);  // nobody need ask whether it was there
}

TEST_F(Cache, IsBuiltAnewWhereAFileIsDamaged) {
  const Variable chosen("LODESTONE_CACHE", folder().c_str());
  ask(scene_);
  const fs::path file = files(folder()).at(0);
  const std::vector<std::byte> good = read_file(file);
  std::vector<std::byte> bad = good;
  bad[good.size() / 2] ^= std::byte(4);
  write_file(file, bad);
  EXPECT_FALSE(ask(scene_));
  EXPECT_EQ(read_file(file), good) << "and mended";
  write_file(file, std::span(good).first(10));
  EXPECT_FALSE(ask(scene_));
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_FALSE(ask(scene_));
}

TEST_F(Cache, TakesNoAtlasOfAnotherScene) {
  const Variable chosen("LODESTONE_CACHE", folder().c_str());
  ask(scene_);
  const fs::path file = files(folder()).at(0);
  const scene::Scene other = test::scene_of({test::height_field(5, 5)});
  save_atlas(file, test::atlas_of(other), {"another hash"});
  EXPECT_FALSE(ask(scene_));
  const scene::Assembly assembly = scene::assemble(scene_);
  save_atlas(file, test::atlas_of(other), {atlas_hash(scene_, assembly, AtlasKind::automatic)});
  EXPECT_FALSE(ask(scene_)) << "of another number of triangles, whatever its hash says";
}

TEST_F(Cache, IsNotNeeded) {
  write_file(folder() / "file", std::string("no folder"));
  const Variable chosen("LODESTONE_CACHE", (folder() / "file" / "cache").c_str());
  EXPECT_FALSE(ask(scene_));
  EXPECT_FALSE(ask(scene_));
}

TEST_F(Cache, LiesWhereTheEnvironmentSays) {
  const Variable chosen("LODESTONE_CACHE", nullptr);
  const fs::path caches = folder() / "xdg", home = folder() / "home";
  {
    const Variable xdg("XDG_CACHE_HOME", caches.c_str()), user("HOME", home.c_str());
    ask(scene_);
    EXPECT_EQ(files(caches / "lodestone").size(), 1u);
    EXPECT_FALSE(fs::exists(home));
  }
  for (const char* none : {static_cast<const char*>(nullptr), "", "relative"}) {
    const Variable xdg("XDG_CACHE_HOME", none), user("HOME", home.c_str());
    fs::remove_all(home);
    ask(scene_);
    EXPECT_EQ(files(home / ".cache" / "lodestone").size(), 1u);
    EXPECT_FALSE(fs::exists("relative"));
  }
  const Variable xdg("XDG_CACHE_HOME", nullptr), user("HOME", nullptr);
  EXPECT_FALSE(ask(scene_));
}

TEST(AtlasHash, CoversEverythingThatAnAtlasIsComputedFrom) {
  std::set<std::string> hashes;
  const auto add = [&](const auto& change, AtlasKind kind = AtlasKind::automatic) {
    scene::Scene scene = sample_scene();
    scene.meshes[1].targets.push_back({"a", {1}, {{0, 0, 1}}, {}, {}});
    scene.meshes[1].weights = {0};
    scene.nodes.emplace_back();
    change(scene);
    const std::string hash = atlas_hash(scene, scene::assemble(scene), kind);
    EXPECT_EQ(hash.size(), 32u);
    EXPECT_TRUE(hashes.insert(hash).second) << hashes.size();
  };
  add([](scene::Scene&) {});
  add([](scene::Scene&) {}, AtlasKind::exact);
  add([](scene::Scene& s) { s.meshes[1].positions[3].z += 1; });
  add([](scene::Scene& s) { std::swap(s.meshes[1].triangles[0], s.meshes[1].triangles[1]); });
  add([](scene::Scene& s) { s.meshes[1].targets[0].positions[0].x = 1; });
  add([](scene::Scene& s) { s.meshes[1].weights[0] = 1; });
  add([](scene::Scene& s) { s.nodes[0].translation.x = 1; });
  add([](scene::Scene& s) { s.nodes[2].mesh = 0; });
  add([](scene::Scene& s) { s.meshes[1].name = "renamed"; });
  add([](scene::Scene& s) { s.meshes[0].grids.clear(); });
  const auto with_material = [](scene::Scene& s) {
    s.images.resize(1);
    s.materials.resize(1);
    s.meshes[1].parts = {{0, 3, 0}};
  };
  add(with_material);
  add([&](scene::Scene& s) {
    with_material(s);
    s.materials[0].transmission_texture.image = 0;
  });
  add([](scene::Scene& s) {
    s.nodes[1].skin = 0;
    s.skins.push_back({"skin", {2}, {glm::mat4(1)}});
    s.meshes[1].first_influence = {0, 1, 2, 3, 4};
    s.meshes[1].influences = {{0, 0.5f}, {0, 1}, {0, 1}, {0, 1}};
  });
}

TEST(AtlasHash, IsTheSameForTheSameScene) {
  const scene::Scene scene = sample_scene();
  scene::Scene renamed = scene;
  renamed.name = "elsewhere.obj";
  renamed.materials.resize(3);
  EXPECT_EQ(atlas_hash(scene, scene::assemble(scene), AtlasKind::exact),
            atlas_hash(renamed, scene::assemble(renamed), AtlasKind::exact));
}

}  // namespace
}  // namespace lodestone::geometry_image
