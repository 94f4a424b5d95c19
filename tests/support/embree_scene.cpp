// SPDX-License-Identifier: MIT
#include "lodestone/test_support/embree_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "lodestone/base/parallel.h"

namespace lodestone::test {

struct EmbreeScene::State {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  RTCGeometry geometry;
  glm::vec3* vertices = nullptr;
  size_t vertex_count = 0;

  explicit State(RTCGeometryType type) : geometry(rtcNewGeometry(device, type)) {}
  ~State() {
    rtcReleaseGeometry(geometry);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void set_build(EmbreeBuild build) {
    if (build == EmbreeBuild::static_scene) return;
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(
        geometry, build == EmbreeBuild::dynamic_refit ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_LOW);
  }

  template <class Item>
  void add_buffer(RTCBufferType type, RTCFormat format, const std::vector<Item>& items) {
    void* to = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Item), items.size());
    std::memcpy(to, items.data(), items.size() * sizeof(Item));
    if constexpr (std::is_same_v<Item, glm::vec3>) {
      vertices = static_cast<glm::vec3*>(to);
      vertex_count = items.size();
    }
  }

  void commit() {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
  }
};

namespace {

// Two triangles a quad, split as ours are.
std::vector<glm::uvec3> triangles_of(const geometry_image::Atlas& atlas) {
  std::vector<glm::uvec3> triangles;
  for (const glm::uvec2& slot : atlas.leaf_map) {
    if (slot.x == layout::empty_slot) continue;
    const uint32_t a = slot.x, b = a + 1, c = a + slot.y, d = c + 1;
    triangles.emplace_back(a, b, c);
    triangles.emplace_back(d, c, b);
  }
  return triangles;
}

std::vector<glm::uvec4> quads_of(const geometry_image::Atlas& atlas) {
  std::vector<glm::uvec4> quads;
  for (const glm::uvec2& slot : atlas.leaf_map) {
    if (slot.x != layout::empty_slot)
      quads.emplace_back(slot.x, slot.x + 1, slot.x + slot.y + 1, slot.x + slot.y);
  }
  return quads;
}

std::vector<RTCGrid> grids_of(const geometry_image::Atlas& atlas) {
  std::vector<RTCGrid> grids;
  for (const layout::ChartRecord& chart : atlas.charts) {
    if (std::max(chart.width, chart.height) > 32767)
      throw std::invalid_argument("a chart is too large for a grid");
    grids.push_back({chart.first_texel, chart.width, static_cast<uint16_t>(chart.width),
                     static_cast<uint16_t>(chart.height)});
  }
  return grids;
}

RTCGeometryType type_of(EmbreeShape shape) {
  constexpr RTCGeometryType types[] = {RTC_GEOMETRY_TYPE_TRIANGLE, RTC_GEOMETRY_TYPE_QUAD,
                                       RTC_GEOMETRY_TYPE_GRID};
  return types[size_t(shape)];
}

RTCRayHit query_of(const Rays& rays, uint64_t i) {
  const glm::vec4 from = rays[2 * i], along = rays[2 * i + 1];
  RTCRayHit query;
  query.ray = {from.x, from.y, from.z, from.w, along.x, along.y, along.z, 0, along.w, ~0u, 0, 0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

EmbreeHit hit_of(const RTCRayHit& query) {
  const bool hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  return {query.ray.tfar, query.hit.u, query.hit.v, hit ? query.hit.primID : ~0u};
}

void intersect_eight(RTCScene scene, const Rays& rays, uint64_t begin, uint64_t end,
                     std::vector<EmbreeHit>& hits) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (uint64_t first = begin; first < end; first += 8) {
    alignas(32) int valid[8];
    RTCRayHit8 query;
    for (uint32_t k = 0; k < 8; ++k) {
      const uint64_t i = std::min(first + k, end - 1);
      valid[k] = first + k < end ? -1 : 0;
      const RTCRayHit one = query_of(rays, i);
      query.ray.org_x[k] = one.ray.org_x;
      query.ray.org_y[k] = one.ray.org_y;
      query.ray.org_z[k] = one.ray.org_z;
      query.ray.tnear[k] = one.ray.tnear;
      query.ray.dir_x[k] = one.ray.dir_x;
      query.ray.dir_y[k] = one.ray.dir_y;
      query.ray.dir_z[k] = one.ray.dir_z;
      query.ray.time[k] = 0;
      query.ray.tfar[k] = one.ray.tfar;
      query.ray.mask[k] = ~0u;
      query.ray.id[k] = query.ray.flags[k] = 0;
      query.hit.geomID[k] = query.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, scene, &context, &query);
    for (uint32_t k = 0; k < 8 && first + k < end; ++k) {
      const bool hit = query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
      hits[first + k] = {query.ray.tfar[k], query.hit.u[k], query.hit.v[k], hit ? query.hit.primID[k] : ~0u};
    }
  }
}

void intersect_stream(RTCScene scene, const Rays& rays, uint64_t begin, uint64_t end,
                      std::vector<EmbreeHit>& hits) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  constexpr uint64_t run = 256;
  alignas(64) RTCRayHit queries[run];
  for (uint64_t first = begin; first < end; first += run) {
    const uint64_t count = std::min(run, end - first);
    for (uint64_t k = 0; k < count; ++k) queries[k] = query_of(rays, first + k);
    rtcIntersect1M(scene, &context, queries, static_cast<unsigned>(count), sizeof(RTCRayHit));
    for (uint64_t k = 0; k < count; ++k) hits[first + k] = hit_of(queries[k]);
  }
}

void intersect_one(RTCScene scene, const Rays& rays, uint64_t begin, uint64_t end,
                   std::vector<EmbreeHit>& hits) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (uint64_t i = begin; i < end; ++i) {
    RTCRayHit query = query_of(rays, i);
    rtcIntersect1(scene, &context, &query);
    hits[i] = hit_of(query);
  }
}

}  // namespace

const char* to_string(EmbreeShape shape) {
  constexpr const char* names[] = {"triangles", "quads", "grids"};
  return names[size_t(shape)];
}

const char* to_string(EmbreeCall call) {
  constexpr const char* names[] = {"1", "8", "1M"};
  return names[size_t(call)];
}

EmbreeScene::EmbreeScene(const std::vector<glm::vec3>& points, const std::vector<glm::uvec3>& triangles,
                         bool robust, EmbreeBuild build)
    : state_(std::make_unique<State>(RTC_GEOMETRY_TYPE_TRIANGLE)) {
  if (robust) rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
  state_->set_build(build);
  state_->add_buffer(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, points);
  state_->add_buffer(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles);
  state_->commit();
}

EmbreeScene::EmbreeScene(const std::vector<glm::vec3>& points, const geometry_image::Atlas& atlas,
                         EmbreeShape shape, EmbreeBuild build)
    : state_(std::make_unique<State>(type_of(shape))) {
  state_->set_build(build);
  state_->add_buffer(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, points);
  if (shape == EmbreeShape::triangles)
    state_->add_buffer(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles_of(atlas));
  if (shape == EmbreeShape::quads)
    state_->add_buffer(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT4, quads_of(atlas));
  if (shape == EmbreeShape::grids) state_->add_buffer(RTC_BUFFER_TYPE_GRID, RTC_FORMAT_GRID, grids_of(atlas));
  state_->commit();
}

EmbreeScene::~EmbreeScene() = default;

void EmbreeScene::intersect(const Rays& rays, std::vector<EmbreeHit>& hits, EmbreeCall call) const {
  hits.resize(rays.size() / 2);
  const auto calls = {intersect_one, intersect_eight, intersect_stream};
  parallel_for(hits.size(), 1024, [&](uint64_t begin, uint64_t end) {
    calls.begin()[size_t(call)](state_->scene, rays, begin, end, hits);
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
