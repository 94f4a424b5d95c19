// SPDX-License-Identifier: MIT
#include "lodestone/render/relaxation.h"

#include <utility>

#include "lodestone/layout/frame.h"
#include "lodestone/layout/relax.h"
#include "lodestone/render/passes.h"

namespace lodestone::render {

Relaxation::Relaxation(Backend& backend, const SceneTables& tables, const geometry_image::Atlas& atlas,
                       Buffer rest_positions)
    : backend_(backend),
      tables_(tables),
      inner_(geometry_image::inner_texels(atlas.charts)),
      texels_(static_cast<uint32_t>(atlas.texel_map.size())),
      rest_positions_(std::move(rest_positions)),
      inner_texels_(make_buffer(backend, "inner_texels", 4, inner_.texels)),
      map_faces_(make_buffer(backend, "map_faces", 16, atlas.maps.faces)),
      map_points_(make_buffer(backend, "map_points", 4, atlas.maps.points)),
      map_pieces_(make_buffer(backend, "map_pieces", 4, atlas.maps.pieces)),
      map_sites_(make_buffer(backend, "map_sites", 16, atlas.maps.sites)),
      texel_map_(backend, {"relaxed_map", texels_, 16}),
      sites_(backend, {"sites", texels_, 16}),
      now_(backend, {"now", texels_, 16}),
      was_(backend, {"was", texels_, 16}) {}

void Relaxation::run(BufferId positions, uint32_t sweeps) {
  const std::vector<BufferId> begin = {tables_.texel_map.id(),
                                       tables_.triangles.id(),
                                       positions,
                                       rest_positions_.id(),
                                       map_sites_.id(),
                                       texel_map_.id(),
                                       sites_.id(),
                                       now_.id(),
                                       was_.id()};
  const layout::CountPush all{texels_};
  backend_.run({&passes::relax_begin, begin, std::as_bytes(std::span(&all, 1)), texels_, {}});
  const std::vector<BufferId> measure = {inner_texels_.id(), tables_.charts.id(), texel_map_.id(),
                                         now_.id(),          was_.id(),           sites_.id()};
  const std::vector<BufferId> move = {
      inner_texels_.id(), tables_.charts.id(), tables_.triangles.id(), positions,       rest_positions_.id(),
      map_faces_.id(),    map_points_.id(),    map_pieces_.id(),       texel_map_.id(), sites_.id(),
      now_.id(),          was_.id(),           map_sites_.id()};
  const auto inner = static_cast<uint32_t>(inner_.texels.size());
  for (uint32_t sweep = 0; sweep < sweeps; ++sweep) {
    run_on(passes::relax_measure, measure, 0, inner);
    for (uint32_t color = 0; color < geometry_image::InnerTexels::colors; ++color)
      run_on(passes::relax_move, move, inner_.first[color], inner_.first[color + 1]);
  }
}

// A pass over a run of the inner texels.
void Relaxation::run_on(const PassDecl& pass, const std::vector<BufferId>& buffers, uint32_t first,
                        uint32_t end) {
  const layout::RelaxPush push{first, end - first};
  if (push.count > 0) backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), push.count, {}});
}

}  // namespace lodestone::render
