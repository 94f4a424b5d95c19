// SPDX-License-Identifier: MIT
// The buffers that layout/surface.h reads, slots 0 to 18 of `mask`, `shade`, `aov` and their like, and that
// header itself. Included once a SIMD target.

#if defined(LODESTONE_SURFACE_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_SURFACE_KERNEL_INL_H_
#undef LODESTONE_SURFACE_KERNEL_INL_H_
#else
#define LODESTONE_SURFACE_KERNEL_INL_H_
#endif

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

HWY_ATTR inline Ray select(bvec1 condition, const Ray& yes, const Ray& no) {
  return {select(condition, yes.origin, no.origin), select(condition, yes.tmin, no.tmin),
          select(condition, yes.direction, no.direction), select(condition, yes.tmax, no.tmax)};
}

HWY_ATTR inline RayCone select(bvec1 condition, const RayCone& yes, const RayCone& no) {
  return {select(condition, yes.apex, no.apex), select(condition, yes.width, no.width),
          select(condition, yes.spread, no.spread)};
}

// Without `is_layered` both must be plain.
template <bool is_layered = true>
HWY_ATTR inline Surface select(bvec1 condition, const Surface& yes, const Surface& no) {
  Surface s;
  s.position = select(condition, yes.position, no.position);
  s.reach = select(condition, yes.reach, no.reach);
  s.geometric = select(condition, yes.geometric, no.geometric);
  s.normal = select(condition, yes.normal, no.normal);
  s.view = select(condition, yes.view, no.view);
  s.albedo = select(condition, yes.albedo, no.albedo);
  s.emission = select(condition, yes.emission, no.emission);
  s.alpha = select(condition, yes.alpha, no.alpha);
  s.metallic = select(condition, yes.metallic, no.metallic);
  s.roughness = select(condition, yes.roughness, no.roughness);
  s.occlusion = select(condition, yes.occlusion, no.occlusion);
  s.texcoord = select(condition, yes.texcoord, no.texcoord);
  if constexpr (is_layered) {
    s.f0 = select(condition, yes.f0, no.f0);
    s.f90 = select(condition, yes.f90, no.f90);
    s.ior = select(condition, yes.ior, no.ior);
    s.transmission = select(condition, yes.transmission, no.transmission);
    s.solid = select(condition, yes.solid, no.solid);
    s.inside = select(condition, yes.inside, no.inside);
    s.attenuation = select(condition, yes.attenuation, no.attenuation);
    s.clearcoat = select(condition, yes.clearcoat, no.clearcoat);
    s.clearcoat_roughness = select(condition, yes.clearcoat_roughness, no.clearcoat_roughness);
    s.clearcoat_normal = select(condition, yes.clearcoat_normal, no.clearcoat_normal);
  } else {
    make_plain(s);
  }
  return s;
}

// `source_count` and `is_layered` are `sources` and `layered` of that header, at compile time as in the
// kernels.
template <class Probe, uint32_t source_count, bool is_layered = false>
class SurfaceKernel : public VaryingKernel<Probe> {
 public:
  using VaryingKernel<Probe>::VaryingKernel;

 protected:
  void count_read(uint32_t words) { VaryingKernel<Probe>::count_read(words); }

  Quads hits = this->quads(0), geometry = this->quads(1), normal_map = this->quads(2),
        texel_map = this->quads(3), triangles = this->quads(4), positions = this->quads(5),
        normals = this->quads(6), tangents = this->quads(7), texcoords = this->quads(8);
  Words images = this->words(9), emitter_numbers = this->words(10);
  Quads charts = this->quads(11);
  Structs<PartRecord> parts = this->template structs<PartRecord>(12);
  Structs<MaterialRecord> materials = this->template structs<MaterialRecord>(13);
  Structs<TextureRecord> textures = this->template structs<TextureRecord>(14);
  Structs<FrameRecord> frames = this->template structs<FrameRecord>(15);
  Words ray_words = this->words(16);
  Quads instances = this->quads(17);
  Words collapses = this->words(18);
  uint32_t placing = this->constant(4), instanced = placing & placing_instances, segments = this->constant(5);

  static constexpr uint32_t sources = source_count, layered = is_layered ? 1 : 0;
#define LOAD4(result, buffer, i) result = this->load(buffer, i)
#define LOAD1(result, buffer, i) result = this->load(buffer, i)
#define WHERE(condition) if (const Where here(*this, condition); here.any())
#define SET(variable, value) variable = select(this->active(), value, variable)
#include "lodestone/layout/surface.h"
#undef LOAD4
#undef LOAD1
#undef WHERE
#undef SET

  // The instances in which the active invocations' rays have hit something.
  HWY_ATTR uvec1 placed_by() {
    if (instanced == 0) return 0u;
    return select(this->active(), this->load(ray_words, this->own_index()), 0u);
  }

  // When.
  HWY_ATTR Moment moment() {
    if (segments == 0) return {0u, 0.0f};
    return moment_of(uintBitsToFloat(this->load(ray_words, this->own_index())), segments);
  }

  bool scattered = true;  // whether rays have been, before this

  HWY_ATTR Tolerance tolerance() {
    Tolerance t;
    const FrameRecord& frame = frames[0];
    t.camera = {frame.origin, frame.tolerance, frame.tolerance_spread};
    t.scattered = no_cone();
    if (placing == placing_cones && scattered)
      t.scattered = stored_cone(this->load_own(instances, 2), this->load_own(instances, 2, 1));
    return t;
  }

  // The cone of rays that leave what the active invocations' rays have hit.
  HWY_ATTR RayCone cone_from(const SurfacePoint& point, const Surface& surface, vec1 spread) {
    return leaving_cone(point, surface.position, tolerance(), spread);
  }
  HWY_ATTR void store_cone(const RayCone& cone) {
    this->store_own(instances, as_bits(cone.apex, floatBitsToUint(cone.width)), 2);
    this->store_own(instances, uvec4(floatBitsToUint(cone.spread), 0u, 0u, 0u), 2, 1);
  }

  // Of the active invocations' hits.
  HWY_ATTR SurfacePoint locate_hit(const uvec4& hit) {
    // Nothing absurd where nothing was hit: it would take the slow way of divisions.
    const uvec1 primitive = select(this->active(), hit.w, 0u);
    return locate(primitive, uintBitsToFloat(hit.y), uintBitsToFloat(hit.z), placed_by(), moment(),
                  tolerance());
  }

  // Calls body(part, material) for each part that invocations have hit, with those active that have hit it.
  template <class Body>
  HWY_ATTR void for_each_part(const SurfacePoint& point, const Body& body) {
    this->for_each_value(point.part, [&](uint32_t index) HWY_ATTR {
      const PartRecord& part = parts[index];
      count_read(24);
      body(part, materials[part.material]);
    });
  }

  // Numbers of the sequence `pair` for the pixel of each invocation; `push` says which rays and which sample.
  template <class Push>
  HWY_ATTR vec2 draw(const Push& push, uint pair) const {
    const FrameRecord& frame = frames[0];
    uvec1 px, py;
    ray_pixel(push.first_ray + this->own_index(), frame.width, frame.height, px, py);
    return sample_2d(frame.seed, py * frame.width + px, push.sample_index, pair);
  }

  // What the active invocations' rays along `direction` have hit.
  HWY_ATTR Surface surface_of(const uvec4& hit, const vec3& direction) {
    return surface_of(locate_hit(hit), direction);
  }
  HWY_ATTR Surface surface_of(const SurfacePoint& point, const vec3& direction) {
    Surface surface;
    bool first = true;
    for_each_part(point, [&](const PartRecord&, const MaterialRecord& material) HWY_ATTR {
      const Surface here = surface_at(material, point, direction);
      surface = first ? here : select<is_layered>(this->active(), here, surface);
      first = false;
    });
    return surface;
  }
};

// Defines NAME_block, a BlockFunction (kernel.h), for the pass template PASS. The dispatch's first constant
// is the second argument of the template: 1, 3 or 6.
#define LODESTONE_SURFACE_BLOCK_FUNCTION(NAME, PASS)                                    \
  template <class Probe>                                                                \
  using PASS##OfOne = PASS<Probe, 1>;                                                   \
  template <class Probe>                                                                \
  using PASS##OfThree = PASS<Probe, 3>;                                                 \
  LODESTONE_VARYING_BLOCK_FUNCTION(NAME##_of_one, PASS##OfOne)                          \
  LODESTONE_VARYING_BLOCK_FUNCTION(NAME##_of_three, PASS##OfThree)                      \
  template <class Probe>                                                                \
  using PASS##OfSix = PASS<Probe, detailed_sources>;                                    \
  LODESTONE_VARYING_BLOCK_FUNCTION(NAME##_of_six, PASS##OfSix)                          \
  HWY_ATTR void NAME##_block(const CpuDispatch& dispatch, uint32_t begin, uint32_t end, \
                             render::Counters* counters) {                              \
    const uint32_t sources = dispatch.constants[0];                                     \
    (sources == 1   ? NAME##_of_one_block                                               \
     : sources == 3 ? NAME##_of_three_block                                             \
                    : NAME##_of_six_block)(dispatch, begin, end, counters);             \
  }

// The same for a pass whose template has a third argument: whether the dispatch's second constant is not 0.
#define LODESTONE_LAYERED_SURFACE_BLOCK_FUNCTION(NAME, PASS)                                       \
  template <class Probe, uint32_t source_count>                                                    \
  using PASS##OfPlain = PASS<Probe, source_count, false>;                                          \
  template <class Probe, uint32_t source_count>                                                    \
  using PASS##OfLayered = PASS<Probe, source_count, true>;                                         \
  LODESTONE_SURFACE_BLOCK_FUNCTION(NAME##_plain, PASS##OfPlain)                                    \
  LODESTONE_SURFACE_BLOCK_FUNCTION(NAME##_layered, PASS##OfLayered)                                \
  HWY_ATTR void NAME##_block(const CpuDispatch& dispatch, uint32_t begin, uint32_t end,            \
                             render::Counters* counters) {                                         \
    (dispatch.constants[1] == 0 ? NAME##_plain_block : NAME##_layered_block)(dispatch, begin, end, \
                                                                             counters);            \
  }

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
