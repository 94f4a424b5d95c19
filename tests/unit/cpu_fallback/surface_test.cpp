// SPDX-License-Identifier: MIT
// What a material of a scene has become at a hit: by way of the tables and of surface_at, on the buffers that
// the renderer gives to `aov`.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/layout/shading.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/small_scenes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface_test.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/surface_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

// Writes quads: what layers a surface has.
template <class Probe, uint32_t source_count, bool is_layered>
class Layers : public SurfaceKernel<Probe, source_count, is_layered> {
 public:
  using SurfaceKernel<Probe, source_count, is_layered>::SurfaceKernel;

  HWY_ATTR void operator()() {
    const uvec4 hit = this->load_own(this->hits), along = this->load_own(rays_, 2, 1);
    const Where here(*this, hit.w != no_index);
    if (!here.any()) return;
    const auto point = this->locate_hit(hit);
    this->for_each_part(point, [&](const PartRecord&, const MaterialRecord& material) HWY_ATTR {
      const Surface s = this->surface_at(material, point, as_vec3(along));
      const vec1 one = 1.0f, none = 0.0f;
      const vec3 sides(select(s.inside, one, none), select(s.solid, one, none), s.ior);
      this->store_own(layers_, as_bits(sides, floatBitsToUint(s.transmission)), 4, 0);
      this->store_own(layers_, as_bits(s.attenuation, floatBitsToUint(s.clearcoat)), 4, 1);
      this->store_own(layers_, as_bits(s.f0, floatBitsToUint(s.f90)), 4, 2);
      this->store_own(layers_, as_bits(s.clearcoat_normal, floatBitsToUint(s.clearcoat_roughness)), 4, 3);
    });
  }

 private:
  Quads rays_ = this->quads(19), layers_ = this->quads(20);
};

LODESTONE_LAYERED_SURFACE_BLOCK_FUNCTION(layers, Layers)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {
namespace {

HWY_EXPORT(layers_block);

// The CPU's, keeping what the inputs of the last `aov` and the constants of the last `shade` were.
class KeepingBackend final : public render::Backend {
 public:
  explicit KeepingBackend(std::unique_ptr<render::Backend> inner) : inner_(std::move(inner)) {}
  const render::DeviceInfo& info() const override { return inner_->info(); }
  render::BufferId create(const render::BufferDesc& desc) override { return inner_->create(desc); }
  void destroy(render::BufferId buffer) override { inner_->destroy(buffer); }
  void upload(render::BufferId buffer, std::span<const std::byte> bytes, uint64_t offset) override {
    inner_->upload(buffer, bytes, offset);
  }
  void download(render::BufferId buffer, std::span<std::byte> bytes, uint64_t offset) override {
    inner_->download(buffer, bytes, offset);
  }
  const render::BufferDesc& desc(render::BufferId buffer) const override { return inner_->desc(buffer); }
  std::vector<render::PassRecord> finish() override { return inner_->finish(); }
  uint64_t allocated_bytes() const override { return inner_->allocated_bytes(); }

  void run(const render::Dispatch& dispatch) override {
    const std::string_view pass = dispatch.pass->name;
    if (pass == "shade") layered = dispatch.constants[1];
    if (pass == "aov") {
      sources = dispatch.constants[0];
      invocations = dispatch.invocations;
      buffers.clear();
      for (size_t i = 0; i <= 19; ++i) {
        const render::BufferDesc& desc = inner_->desc(dispatch.buffers[i]);
        std::vector<uint32_t>& words = buffers.emplace_back(desc.elements * desc.element_bytes / 4);
        inner_->download(dispatch.buffers[i], std::as_writable_bytes(std::span(words)), 0);
      }
    }
    inner_->run(dispatch);
  }

  uint32_t sources = 0, layered = 2, invocations = 0;
  std::vector<std::vector<uint32_t>> buffers;

 private:
  std::unique_ptr<render::Backend> inner_;
};

struct Found {
  float inside = -1, solid = -1, ior = -1, transmission = -1;
  glm::vec3 attenuation;
  float clearcoat = -1;
  glm::vec3 f0;
  float f90 = -1;
  glm::vec3 clearcoat_normal;
  float clearcoat_roughness = -1;
};
static_assert(sizeof(Found) == 64);

struct Middle {
  uint32_t layered;     // what the renderer told `shade`
  Found layers, plain;  // of the surface in the middle of the picture with layers, and without
};

Middle middle(const scene::Scene& scene, geometry_image::AtlasKind kind) {
  const test::ReadyScene ready(scene, kind);
  KeepingBackend backend(make_cpu_backend({}));
  render::Settings settings;
  settings.width = settings.height = 16;
  settings.aovs = {"id"};
  render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, settings);
  const scene::Pose pose = ready.pose(0);
  renderer.render(pose,
                  render::find_view(ready.scene, pose, "", scene::pose_bounds(ready.scene, pose), 16, 16));
  std::vector<Found> found(backend.invocations);
  std::vector<uint32_t*> buffers;
  for (std::vector<uint32_t>& words : backend.buffers) buffers.push_back(words.data());
  buffers.push_back(reinterpret_cast<uint32_t*>(found.data()));
  Middle result{.layered = backend.layered, .layers = {}, .plain = {}};
  for (const uint32_t layered : {0u, 1u}) {
    const CpuDispatch dispatch{buffers, {}, backend.invocations, {backend.sources, layered}, false, nullptr};
    HWY_DYNAMIC_DISPATCH(layers_block)(dispatch, 0, backend.invocations, nullptr);
    for (uint32_t ray = 0; ray < backend.invocations; ++ray) {
      uint32_t x, y;
      if (layout::ray_pixel(ray, 16, 16, x, y) && x == 8 && y == 8)
        (layered == 0 ? result.plain : result.layers) = found[ray];
    }
  }
  return result;
}

class Surfaces : public testing::TestWithParam<geometry_image::AtlasKind> {
 protected:
  static Middle of(const scene::Material& material) { return of(material, test::square(0, 0)); }
  static Middle of(const scene::Material& material, const scene::Mesh& mesh,
                   const glm::vec3& scale = glm::vec3(1)) {
    scene::Scene scene = test::facing_camera({mesh}, {material});
    scene.images = images_;
    scene.nodes[0].scale = scale;
    return middle(scene, GetParam());
  }
  static scene::Texture texture(std::array<uint8_t, 4> texel) {
    scene::Image image;
    image.width = image.height = 1;
    image.rgba.assign(texel.begin(), texel.end());
    images_.push_back(image);
    scene::Texture texture;
    texture.image = static_cast<uint32_t>(images_.size() - 1);
    return texture;
  }
  void SetUp() override { images_.clear(); }

  static inline std::vector<scene::Image> images_;
};

void expect_plain(const Found& found) {
  EXPECT_EQ(found.ior, 1.5f);
  EXPECT_EQ(found.f0, glm::vec3(0.04f)) << "to the bit";
  EXPECT_EQ(found.f90, 1);
  EXPECT_EQ(found.transmission, 0);
  EXPECT_EQ(found.solid, 0);
  EXPECT_EQ(found.attenuation, glm::vec3(0));
  EXPECT_EQ(found.clearcoat, 0);
  EXPECT_EQ(found.clearcoat_roughness, 0);
  EXPECT_EQ(found.clearcoat_normal, glm::vec3(0, 0, 1));
}

TEST_P(Surfaces, WithoutLayersArePlainEitherWay) {
  const Middle found = of(scene::Material());
  EXPECT_EQ(found.layered, 0u);
  expect_plain(found.layers);
  expect_plain(found.plain);
}

TEST_P(Surfaces, HaveTheLayersOfTheirMaterial) {
  scene::Material material;
  material.ior = 2;
  material.specular = 0.5f;
  material.specular_color = {0.5f, 1, 20};
  material.transmission = 0.75f;
  material.thickness = 3;
  material.attenuation_color = {1, 0.5f, 0};
  material.attenuation_distance = 2;
  material.clearcoat = 0.25f;
  material.clearcoat_roughness = 0.125f;
  const Middle found = of(material);
  EXPECT_EQ(found.layered, 1u);
  EXPECT_EQ(found.layers.ior, 2);
  EXPECT_NEAR(found.layers.f0.x, 0.5 * 0.5 / 9, 1e-7);
  EXPECT_NEAR(found.layers.f0.y, 0.5 / 9, 1e-7);
  EXPECT_EQ(found.layers.f0.z, 0.5f) << "at most all that is reflected at all";
  EXPECT_EQ(found.layers.f90, 0.5f);
  EXPECT_EQ(found.layers.transmission, 0.75f);
  EXPECT_EQ(found.layers.solid, 1);
  EXPECT_EQ(found.layers.attenuation.x, 0);
  EXPECT_NEAR(std::exp(-found.layers.attenuation.y * 2), 0.5, 1e-6);
  EXPECT_NEAR(std::exp(-found.layers.attenuation.z * 2), 0, 1e-5);
  EXPECT_TRUE(std::isfinite(found.layers.attenuation.z));
  EXPECT_EQ(found.layers.clearcoat, 0.25f);
  EXPECT_EQ(found.layers.clearcoat_roughness, 0.125f);
  expect_plain(found.plain);
}

TEST_P(Surfaces, TakeEachLayerFromItsChannel) {
  scene::Material material;
  material.specular_texture = texture({1, 2, 3, 51});
  material.specular_color_texture = texture({255, 188, 0, 1});
  material.transmission = material.clearcoat = material.clearcoat_roughness = 1;
  material.transmission_texture = texture({102, 1, 2, 3});
  material.clearcoat_texture = texture({153, 1, 2, 3});
  material.clearcoat_roughness_texture = texture({1, 204, 2, 3});
  material.clearcoat_normal_texture = texture({128, 218, 218, 3});
  material.normal_texture = texture({218, 128, 218, 3});
  const Found found = of(material).layers;
  EXPECT_NEAR(found.f90, 0.2, 1e-6);
  EXPECT_NEAR(found.f0.x, 0.04 * 0.2, 1e-6);
  EXPECT_NEAR(found.f0.y, 0.04 * 0.2 * 0.5, 1e-4) << "sRGB";
  EXPECT_EQ(found.f0.z, 0);
  EXPECT_NEAR(found.transmission, 0.4, 1e-6);
  EXPECT_NEAR(found.clearcoat, 0.6, 1e-6);
  EXPECT_NEAR(found.clearcoat_roughness, 0.8, 1e-6);
  EXPECT_NEAR(found.clearcoat_normal.y, 0.707, 0.01) << "its own map";
  EXPECT_NEAR(found.clearcoat_normal.x, 0, 0.01) << "not that below";
}

TEST_P(Surfaces, ReflectAllLightAtAnInfiniteIor) {
  scene::Material material;
  material.ior = 0;
  const Middle found = of(material);
  EXPECT_EQ(found.layered, 1u);
  EXPECT_EQ(found.layers.f0, glm::vec3(1));
  EXPECT_EQ(found.layers.ior, layout::highest_ior);
}

// By the vertices' normals, in whatever order the vertices come.
TEST_P(Surfaces, KnowTheSideThatARayArrivesAt) {
  scene::Material glass;
  glass.transmission = 1;
  for (const glm::vec3& scale : {glm::vec3(1, 1, 1), glm::vec3(-1, 1, 1)}) {
    for (const bool reversed : {false, true}) {
      scene::Mesh mesh = test::square(0, 0);
      if (reversed) mesh.triangles = {{0, 1, 2}, {3, 2, 1}};
      EXPECT_EQ(of(glass, mesh, scale).layers.inside, 0) << scale.x << " " << reversed;
      for (glm::vec3& normal : mesh.normals) normal = -normal;
      const Middle back = of(glass, mesh, scale);
      EXPECT_EQ(back.layers.inside, 1) << scale.x << " " << reversed;
      EXPECT_EQ(back.plain.inside, 0);
      EXPECT_EQ(back.layers.clearcoat_normal, glm::vec3(0, 0, 1)) << "to the viewer";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, Surfaces,
                         testing::Values(geometry_image::AtlasKind::exact, geometry_image::AtlasKind::charts),
                         [](const auto& each) {
                           return each.param == geometry_image::AtlasKind::exact ? "exact" : "charts";
                         });

}  // namespace
}  // namespace lodestone::cpu_fallback
#endif
