// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/surface_kernel.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class Mask : public SurfaceKernel<Probe> {
 public:
  using SurfaceKernel<Probe>::SurfaceKernel;

  void operator()(uint32_t index) {
    const glm::uvec4 hit = this->load(this->hits, index);
    if (!is_cut_out(hit)) return;
    glm::uvec4 from = this->load(rays_, 2 * uint64_t(index));
    from.w = hit.x;
    this->store(rays_, 2 * uint64_t(index), from);
    this->store(states_, index, glm::uvec4(0, 0, layout::trace_restart, hit.w));
    this->add(pending_, 0, 1);
  }

 private:
  bool is_cut_out(const glm::uvec4& hit) {
    if (hit.w == layout::no_index) return false;
    const auto point = this->locate(hit.w, layout::uintBitsToFloat(hit.y), layout::uintBitsToFloat(hit.z));
    const layout::MaterialRecord& material = this->materials[this->parts[point.part].material];
    this->count_read(24);
    if (material.alpha_mask == 0) return false;
    return this->base_color_at(material, point, this->texcoords_at(point)).w < material.alpha_cutoff;
  }

  Quads rays_ = this->quads(16), states_ = this->quads(17);
  Words pending_ = this->words(18);
};

}  // namespace

void mask(const CpuDispatch& dispatch) {
  run_pass<Mask>(dispatch, 512);
}

}  // namespace lodestone::cpu_fallback
