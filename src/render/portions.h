// SPDX-License-Identifier: MIT
// A surface that is larger than the device's memory: its portions come and go, and rays are traced through
// one after the other (layout/portion.h). Pictures are those of the whole, to the bit.
#pragma once

#include <array>
#include <cstdint>
#include <list>
#include <memory>
#include <vector>

#include "lodestone/geometry_image/portions.h"
#include "lodestone/layout/portion.h"
#include "lodestone/render/backend.h"
#include "lodestone/render/geometry_image.h"
#include "lodestone/render/renderer.h"
#include "lodestone/render/tracing.h"

namespace lodestone::render {

// Of rays of one kind, what is known of the surface that they have hit.
struct FoundSurface {
  FoundSurface() = default;
  FoundSurface(Backend& backend, const std::string& prefix, uint64_t rays, uint32_t sources);

  SurfaceBuffers buffers() const;

  Buffer hits;  // as RayBuffers::hits, of primitives in `geometry`
  Buffer geometry, normal_map, texel_map, triangles, positions, normals, tangents, texcoords, charts;
};

class Portions {
 public:
  // `first_emitters`: as SceneTables; `rest`: the rest pose; `bytes`: what the whole would take on the
  // device. Throws Error(usage) where Settings::device_memory leaves too little beside what the back end has
  // allocated already; what must be of this class itself is for at most `rays` rays. All references must
  // outlive it.
  Portions(Backend& backend, const scene::Scene& scene, const scene::Assembly& assembly,
           const geometry_image::Atlas& atlas, const Settings& settings,
           const std::vector<uint32_t>& first_emitters, const PosedVertices& rest, uint64_t bytes,
           uint32_t rays, bool masks);
  ~Portions();

  // As GeometryImage::update, of the whole: where its portions are from now on.
  void update(const PosedVertices& pose, const std::vector<PosedVertices>& shutter,
              const std::vector<scene::Bounds>& boxes);

  // Where rays come from at first: portions that are near are best loaded first.
  void set_eye(const glm::vec3& eye) { eye_ = eye; }

  // As Tracing::trace. `found`: where the surface that rays hit is kept; null: nowhere.
  bool trace(const RayBuffers& rays, uint32_t count, const TraceQuery& query, const Interrupted& interrupted,
             const FoundSurface* found);

  const FoundSurface& found() const { return found_; }  // of the camera's rays, and where they go on
  const FoundSurface& found_by_shadows() const { return shadow_found_; }  // where materials cut out texels
  // All charts that shine, always there, to draw points of them; null: there are none. And where it has these
  // texels of the atlas, which ascend or are 0.
  const GeometryImage* emitter_image() const;
  std::vector<uint32_t> emitter_texels(const std::vector<uint32_t>& texels) const;
  uint32_t sources() const { return sources_; }
  Traversal traversal() const { return settings_.traversal; }
  const Streaming& streaming() const { return streaming_; }

 private:
  struct Resident;

  void reserve(uint32_t rays);
  void load_emitters();
  std::vector<uint32_t> emitters_of(const std::vector<geometry_image::ChartPiece>& pieces) const;
  void plan(const Settings& settings, uint64_t bytes);
  uint64_t bytes_of(const geometry_image::Portion& portion) const;
  template <class Push>
  void run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push, uint32_t invocations,
           const std::array<uint32_t, pass_constants>& constants) {
    backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), invocations, constants});
  }
  void enter(const RayBuffers& rays, const layout::PortionPush& push, const TraceQuery& query,
             const Buffer& runs);
  bool wants(const RayBuffers& rays, const layout::PortionPush& push, const TraceQuery& query);
  std::vector<uint32_t> order() const;
  void end(const RayBuffers& rays, const layout::PortionPush& push, const TraceQuery& query,
           const Resident& resident, const FoundSurface* found);
  layout::PortionPush push_of(uint32_t portion, uint32_t count, bool restarted) const;
  Resident& load(uint32_t portion);
  void make_room(uint64_t bytes);
  void place(Resident& resident);

  Backend& backend_;
  const scene::Assembly& assembly_;
  const geometry_image::Atlas& atlas_;
  Settings settings_;
  const std::vector<uint32_t>& first_emitters_;
  uint32_t sources_;
  RayBuffers local_;  // of `capacity_` rays
  uint32_t capacity_ = 0;
  FoundSurface found_, shadow_found_;
  Buffer wanted_, no_runs_;
  geometry_image::PortionMaker maker_;
  std::vector<glm::vec3> rest_;
  std::vector<std::vector<geometry_image::ChartPiece>> portions_;
  std::vector<uint64_t> portion_bytes_;  // of each on the device; 0: not known yet
  glm::vec3 eye_{0};
  // Of the pose.
  PosedVertices pose_;
  std::vector<PosedVertices> shutter_;
  std::vector<scene::Bounds> boxes_;                  // of the whole
  float extent_ = 0;                                  // of all of these
  std::vector<scene::Bounds> bounds_;                 // a portion each, of all of the shutter's time
  std::vector<std::vector<scene::Bounds>> segments_;  // the same, of each segment; of one where nothing moves
  std::list<Resident> residents_;                     // those loaded last at the end
  std::unique_ptr<Resident> emitters_;
  std::vector<geometry_image::TexelRun> emitter_runs_;
  Streaming streaming_;
};

}  // namespace lodestone::render
