// SPDX-License-Identifier: MIT
// Relaxation of the geometry image, frame by frame ("Reparameterization" in the paper's future work): texels
// of mapped charts move within their charts to where the pose stretches the surface.
#pragma once

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/render/backend.h"
#include "lodestone/render/scene_tables.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::render {

class Relaxation {
 public:
  // Uploads what does not change. The atlas must have maps; `tables` are of the same scene and atlas, and
  // `rest_positions` what `blend` makes of the rest pose.
  Relaxation(Backend& backend, const SceneTables& tables, const geometry_image::Atlas& atlas,
             Buffer rest_positions);

  // Runs the sweeps (at least 1) for the pose whose vertices are in `positions`. Every call begins with the
  // atlas's own texel map, so a frame does not depend on those before it.
  void run(BufferId positions, uint32_t sweeps);

  // What the last run made: a texel map of this pose.
  BufferId texel_map() const { return texel_map_.id(); }

 private:
  void run_on(const PassDecl& pass, const std::vector<BufferId>& buffers, uint32_t first, uint32_t end);

  Backend& backend_;
  const SceneTables& tables_;
  geometry_image::InnerTexels inner_;
  uint32_t texels_;
  Buffer rest_positions_, inner_texels_, map_faces_, map_points_, map_pieces_, map_sites_;
  Buffer texel_map_, sites_, now_, was_;
};

}  // namespace lodestone::render
