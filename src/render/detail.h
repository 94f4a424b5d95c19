// SPDX-License-Identifier: MIT
// Levels of detail of the geometry image, made anew with every frame (shaders/layout/detail.h).
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/collapse_map.h"
#include "lodestone/layout/detail.h"
#include "lodestone/render/backend.h"
#include "lodestone/render/renderer.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::render {

// What rays of a picture tolerate, before they are scattered: an error that looks as large as
// `pixels_of_error` of its pixels, wherever it is.
layout::RayCone camera_cone(const View& view, uint32_t width, uint32_t height, float pixels_of_error);

// The most that tolerances of rays with that camera may change a unit of length: what scattered rays get is
// cut at this.
float steepest_cone(const layout::RayCone& camera);

class Detail {
 public:
  // Uploads what does not change. `first_emitters`: as SceneTables has it; what shines keeps its detail,
  // for every ray must see the triangles of which points are drawn. Throws Error(usage) where there are more
  // texels than primitives can name.
  Detail(Backend& backend, const scene::Assembly& assembly, const geometry_image::Atlas& atlas,
         const std::vector<uint32_t>& first_emitters);

  // Errors and radii of the geometry image. No ray's tolerance may change by more than `steepest` a unit.
  void build(const Buffer& geometry, float steepest);

  // The number of the root of each object's tree in `node_details` and `coarse_quads`.
  uint32_t first_node(size_t object) const { return first_nodes_[object]; }
  const Buffer& collapses() const { return collapses_; }
  const Buffer& node_details() const { return node_details_; }
  const Buffer& coarse_quads() const { return coarse_quads_; }

 private:
  void upload_nodes(const geometry_image::Atlas& atlas, const geometry_image::CollapseMap& map);
  void run_on_texels(const PassDecl& pass, const std::vector<BufferId>& buffers);
  void run_on_nodes(const PassDecl& pass, const std::vector<BufferId>& buffers,
                    const std::vector<uint32_t>& ends, float steepest);

  Backend& backend_;
  uint32_t texels_;
  std::vector<uint32_t> levels_, steps_;  // their ends, see CollapseMap
  std::vector<uint32_t> first_nodes_;
  Buffer points_, coarse_nodes_, coarse_order_, coarse_quads_;
  Buffer collapses_, radii_, node_details_;
};

}  // namespace lodestone::render
