// SPDX-License-Identifier: MIT
#include "lodestone/render/emitters.h"

#include <algorithm>

#include "lodestone/layout/emitters.h"
#include "lodestone/render/number_shares.h"
#include "lodestone/render/scene_tables.h"

namespace lodestone::render {

Emitters::Emitters(Backend& backend, const EmitterData& data, uint64_t rays)
    : backend_(backend),
      numbers_(make_buffer(backend, "emitter_numbers", 4, data.numbers)),
      texels_(make_buffer(backend, "emitter_texels", 4, data.texels)),
      drawn_(backend, {"drawn_points", layout::drawn_quads * rays, 16}) {
  std::vector<glm::uvec2> halves;
  uint32_t most = 0;
  for (const EmitterData::Object& object : data.objects) {
    powers_.push_back(object.power);
    halves.emplace_back(object.first_half, object.end_half);
    most = std::max(most, object.end_half - object.first_half);
  }
  objects_ = make_buffer(backend, "emitter_objects", 4, halves);
  half_step_ = greatest_step(most);
}

void Emitters::place(const std::vector<uint32_t>& texels) {
  backend_.upload(texels_.id(), std::as_bytes(std::span(texels)));
}

}  // namespace lodestone::render
