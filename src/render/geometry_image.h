// SPDX-License-Identifier: MIT
// A surface on the device, made anew for every pose: its vertices, the geometry image that samples them, and
// the hierarchy over that.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/layout/detail.h"
#include "lodestone/render/backend.h"
#include "lodestone/render/detail.h"
#include "lodestone/render/relaxation.h"
#include "lodestone/render/renderer.h"
#include "lodestone/render/scene_tables.h"
#include "lodestone/render/tracing.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/pose.h"

namespace lodestone::render {

// What `blend` makes vertices of a pose from: scene::frame_weights and scene::frame_matrices.
struct PosedVertices {
  std::vector<float> weights;
  std::vector<glm::vec4> matrices;
  friend bool operator==(const PosedVertices&, const PosedVertices&) = default;
};

// What passes read of the surface that rays have hit (slots 1 to 8 and 11 of
// shaders/geometry_image/surface.glsl).
struct SurfaceBuffers {
  BufferId geometry, normal_map, texel_map, triangles, positions, normals, tangents, texcoords, charts;
};

class GeometryImage {
 public:
  // Uploads what does not change; `first_emitters` as SceneTables. Throws Error(usage) where
  // --pixels-of-error is wanted of what has no levels of detail.
  GeometryImage(Backend& backend, const scene::Assembly& assembly, const geometry_image::Atlas& atlas,
                const Settings& settings, const std::vector<uint32_t>& first_emitters);

  GeometryImage(const GeometryImage&) = delete;  // its parts know each other by address
  GeometryImage& operator=(const GeometryImage&) = delete;

  // Of the texels of mapped charts, with every pose from now on. Throws Error(usage) where the atlas, that of
  // the constructor, has no maps; `name` of the scene.
  void relax(const geometry_image::Atlas& atlas, const PosedVertices& rest, const std::string& name);

  // What rays tolerate that have not been scattered.
  void set_camera(const layout::RayCone& camera);

  // blend, relax, rasterise, detail, bounds: everything that follows from the pose. `shutter`: with motion
  // blur, the vertices at the ends of its segments. `boxes`: one an object, round all of its surface, of each
  // segment; `whole`: of each the box that ObjectRecord::extent is of, where it is not the same.
  void update(const PosedVertices& pose, const std::vector<PosedVertices>& shutter,
              const std::vector<scene::Bounds>& boxes, const std::vector<scene::Bounds>& whole);

  // As Tracing::trace.
  bool trace(const RayBuffers& rays, uint32_t count, const TraceQuery& query,
             const Interrupted& interrupted) {
    return tracing_.trace(geometry_, rays, count, query, interrupted);
  }

  SurfaceBuffers buffers() const;
  BufferId texel_map() const;  // of the pose
  const Buffer& geometry() const { return geometry_; }
  const std::optional<Detail>& detail() const { return detail_; }
  Tracing& tracing() { return tracing_; }
  const Tracing& tracing() const { return tracing_; }
  uint32_t texels() const { return texels_; }  // of one image
  uint32_t sources() const { return detail_ ? layout::detailed_sources : tables_.sources; }

 private:
  template <class Push>
  void run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push,
           uint32_t invocations);
  void blend(const PosedVertices& vertices, const Buffer& positions);
  void rasterise(uint32_t first_texel, uint32_t image);

  Backend& backend_;
  SceneTables tables_;
  std::vector<scene::Object> objects_;
  std::vector<geometry_image::AtlasObject> atlas_objects_;
  bool has_tangents_;
  uint32_t texels_, sweeps_;
  std::optional<Detail> detail_;
  Tracing tracing_;
  std::optional<Relaxation> relaxation_;
  layout::RayCone camera_{};
  bool rigid_done_ = false;  // rigid objects are as they will always be
  Buffer weights_, matrices_, positions_, normals_, tangents_, geometry_, normal_map_;
};

}  // namespace lodestone::render
