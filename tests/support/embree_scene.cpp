// SPDX-License-Identifier: MIT
#include "lodestone/test_support/embree_scene.h"

#include <embree3/rtcore.h>

#include <cstring>

#include "lodestone/base/parallel.h"

namespace lodestone::test {

struct EmbreeScene::State {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  glm::vec3* vertices = nullptr;
  size_t vertex_count = 0;
  ~State() {
    rtcReleaseGeometry(geometry);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

EmbreeScene::EmbreeScene(const std::vector<glm::vec3>& points, const std::vector<glm::uvec3>& triangles,
                         bool robust, EmbreeBuild build)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  if (robust) rtcSetSceneFlags(s.scene, RTC_SCENE_FLAG_ROBUST);
  if (build != EmbreeBuild::static_scene) {
    rtcSetSceneFlags(s.scene, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(s.scene, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(
        s.geometry, build == EmbreeBuild::dynamic_refit ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_LOW);
  }
  s.vertex_count = points.size();
  s.vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      s.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), points.size()));
  std::memcpy(s.vertices, points.data(), points.size() * sizeof(glm::vec3));
  void* indices = rtcSetNewGeometryBuffer(s.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          sizeof(glm::uvec3), triangles.size());
  std::memcpy(indices, triangles.data(), triangles.size() * sizeof(glm::uvec3));
  rtcCommitGeometry(s.geometry);
  rtcAttachGeometry(s.scene, s.geometry);
  rtcCommitScene(s.scene);
}

EmbreeScene::~EmbreeScene() = default;

void EmbreeScene::intersect(const Rays& rays, std::vector<EmbreeHit>& hits) const {
  hits.resize(rays.size() / 2);
  parallel_for(hits.size(), 1024, [&](uint64_t begin, uint64_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (uint64_t i = begin; i < end; ++i) {
      const glm::vec4 from = rays[2 * i], along = rays[2 * i + 1];
      RTCRayHit query;
      query.ray = {from.x, from.y, from.z, from.w, along.x, along.y, along.z, 0, along.w, ~0u, 0, 0};
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(state_->scene, &context, &query);
      const bool hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
      hits[i] = {query.ray.tfar, query.hit.u, query.hit.v, hit ? query.hit.primID : ~0u};
    }
  });
}

void EmbreeScene::update(const std::vector<glm::vec3>& points) {
  std::memcpy(state_->vertices, points.data(), points.size() * sizeof(glm::vec3));
  recommit();
}

void EmbreeScene::recommit() {
  rtcUpdateGeometryBuffer(state_->geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(state_->geometry);
  rtcCommitScene(state_->scene);
}

}  // namespace lodestone::test
