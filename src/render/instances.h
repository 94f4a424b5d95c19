// SPDX-License-Identifier: MIT
// The upper level of the hierarchy (layout/objects.h), built every frame, and rays traced through both: in
// rounds, each of which takes every ray that is still on its way through one instance.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/render/backend.h"
#include "lodestone/render/hierarchy_levels.h"
#include "lodestone/render/tracing.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::render {

class Instances {
 public:
  // `assembly` must outlive it.
  Instances(Backend& backend, const scene::Assembly& assembly, uint32_t loop_budget);

  // Sorts the instances and makes the tree over them. `matrices`: one an instance; `boxes`: one an object,
  // round all of its surface; `objects`: Tracing::objects(). An instance whose matrix has no inverse is not
  // seen. `powers`: Emitters::powers(), by which instances are drawn as lights; empty: none is.
  void build(const std::vector<glm::mat4>& matrices, const std::vector<scene::Bounds>& boxes,
             const Buffer& objects, const std::vector<double>& powers);

  // As Tracing::trace; rays.instances says in which instance each hit is.
  bool trace(Tracing& tracing, const Buffer& geometry, const RayBuffers& rays, uint32_t count,
             const TraceQuery& query, const Interrupted& interrupted);

  const Buffer& records() const { return records_; }  // layout::InstanceRecord
  const Buffer& numbers() const { return numbers_; }  // layout/draw_emitter.h
  double emitter_power() const { return emitter_power_; }
  uint32_t count() const { return count_; }

 private:
  template <class Push>
  void run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push, uint32_t invocations,
           const std::array<uint32_t, pass_constants>& constants = {});
  void share_out_emitters(std::vector<layout::InstanceRecord>& records, const std::vector<double>& powers);
  void sort();
  void build_tree();
  void reserve(uint32_t rays);
  uint32_t enter(const RayBuffers& rays, uint32_t count, uint32_t round, const TraceQuery& query);

  Backend& backend_;
  const scene::Assembly& assembly_;
  uint32_t count_, loop_budget_;
  HierarchyLevels levels_;
  float rounding_ = 1;        // the largest of all instances
  double emitter_power_ = 0;  // of all instances
  float extent_ = 0;          // the largest absolute coordinate
  layout::BoxGrid grid_{};
  Buffer records_, numbers_, lo_, hi_, keys_, sorted_, boxes_;
  // Of the rays on their way.
  uint32_t capacity_ = 0;
  RayBuffers local_;
  Buffer owners_, next_owners_, roots_, found_, block_counts_, block_starts_, entered_;
};

}  // namespace lodestone::render
