// SPDX-License-Identifier: MIT
#include "lodestone/render/passes.h"

#include "lodestone/layout/boxes.h"
#include "lodestone/layout/denoise.h"
#include "lodestone/layout/detail_nodes.h"
#include "lodestone/layout/emitters.h"
#include "lodestone/layout/frame.h"
#include "lodestone/layout/links.h"
#include "lodestone/layout/objects.h"
#include "lodestone/layout/portion.h"
#include "lodestone/layout/ray_list.h"
#include "lodestone/layout/recursion.h"
#include "lodestone/layout/relax.h"
#include "lodestone/layout/trace.h"

namespace lodestone::render::passes {
namespace {

using enum Access;
using enum BindingKind;

constexpr Binding links_bindings[] = {{"leaf_map", word, read}, {"links", word, write}};

constexpr Binding blend_bindings[] = {
    {"base_positions", quad, read}, {"base_normals", quad, read},    {"base_tangents", quad, read},
    {"vertex_ranges", quad, read},  {"morph_positions", quad, read}, {"morph_normals", quad, read},
    {"morph_tangents", quad, read}, {"influences", word, read},      {"weights", word, read},
    {"matrices", quad, read},       {"positions", quad, write},      {"normals", quad, write},
    {"tangents", quad, write}};

constexpr Binding relax_begin_bindings[] = {
    {"texel_map", quad, read},      {"triangles", quad, read}, {"positions", quad, read},
    {"rest_positions", quad, read}, {"map_sites", quad, read}, {"relaxed_map", quad, write},
    {"sites", quad, write},         {"now", quad, write},      {"was", quad, write}};

constexpr Binding relax_measure_bindings[] = {{"inner_texels", word, read}, {"charts", quad, read},
                                              {"relaxed_map", quad, read},  {"now", quad, read},
                                              {"was", quad, read},          {"sites", quad, read_write}};

constexpr Binding relax_move_bindings[] = {
    {"inner_texels", word, read}, {"charts", quad, read},         {"triangles", quad, read},
    {"positions", quad, read},    {"rest_positions", quad, read}, {"map_faces", quad, read},
    {"map_points", word, read},   {"map_pieces", word, read},     {"relaxed_map", quad, read_write},
    {"sites", quad, read_write},  {"now", quad, read_write},      {"was", quad, write},
    {"map_sites", quad, read}};

constexpr Binding rasterise_bindings[] = {{"texel_map", quad, read}, {"triangles", quad, read},
                                          {"positions", quad, read}, {"normals", quad, read},
                                          {"geometry", quad, write}, {"normal_map", quad, write}};

constexpr Binding bounds_leaves_bindings[] = {
    {"leaf_map", word, read}, {"geometry", quad, read}, {"nodes_lo", quad, write}, {"nodes_hi", quad, write}};

constexpr Binding bounds_bindings[] = {{"nodes_lo", quad, read_write}, {"nodes_hi", quad, read_write}};

constexpr Binding camera_bindings[] = {
    {"frame", structs, read}, {"rays", quad, write}, {"cameras", quad, read}, {"times", word, write}};

#define RAY_BINDINGS                                                                                        \
  {"rays", quad, read}, {"geometry", quad, read}, {"hits", quad, read_write}, {"states", quad, read_write}, \
      {"steps", word, read_write}, {                                                                        \
    "pending", structs, read_write                                                                          \
  }

#define OBJECT_BINDINGS                             \
  {"objects", quad, read}, {"roots", word, read}, { \
    "times", word, read                             \
  }

#define DETAIL_BINDINGS                                                                    \
  {"collapses", word, read}, {"node_details", quad, read}, {"coarse_quads", quad, read}, { \
    "cones", quad, read                                                                    \
  }

#define LIST_BINDINGS \
  { "ray_list", word, read }

constexpr Binding trace_threaded_bindings[] = {
    RAY_BINDINGS,          {"nodes_lo", quad, read}, {"nodes_hi", quad, read},
    {"links", word, read}, OBJECT_BINDINGS,          DETAIL_BINDINGS,
    LIST_BINDINGS};

constexpr Binding trace_octant_bindings[] = {
    RAY_BINDINGS,    {"nodes_lo", quad, read}, {"nodes_hi", quad, read},
    OBJECT_BINDINGS, DETAIL_BINDINGS,          LIST_BINDINGS};

// The CPU's traversal.
constexpr Binding trace_wide_bindings[] = {
    RAY_BINDINGS, {"wide_nodes", structs, read}, {"leaf_map", word, read}, OBJECT_BINDINGS, DETAIL_BINDINGS,
    LIST_BINDINGS};

constexpr Binding trace_boxes_bindings[] = {RAY_BINDINGS,
                                            {"boxes", quad, read},
                                            {"leaf_map", word, read},
                                            {"trails", quad, read_write},
                                            OBJECT_BINDINGS,
                                            DETAIL_BINDINGS,
                                            LIST_BINDINGS};

// Its leaf map is read in pairs of slots.
constexpr Binding trace_tile_bindings[] = {RAY_BINDINGS,    {"boxes", quad, read}, {"leaf_map", quad, read},
                                           OBJECT_BINDINGS, DETAIL_BINDINGS,       LIST_BINDINGS};

#undef LIST_BINDINGS
#undef DETAIL_BINDINGS
#undef OBJECT_BINDINGS
#undef RAY_BINDINGS

constexpr Binding detail_begin_bindings[] = {{"collapses", word, read}, {"radii", structs, write}};

#define COARSE_NODE_BINDINGS                                                                                 \
  {"coarse_nodes", quad, read}, {"geometry", quad, read}, {"collapses", word, read}, {"points", word, read}, \
      {"node_details", quad, read_write}, {                                                                  \
    "radii", structs, read_write                                                                             \
  }
constexpr Binding detail_measure_bindings[] = {COARSE_NODE_BINDINGS};
constexpr Binding detail_settle_bindings[] = {COARSE_NODE_BINDINGS, {"coarse_order", word, read}};
#undef COARSE_NODE_BINDINGS

constexpr Binding detail_end_bindings[] = {
    {"collapses", word, read_write}, {"points", word, read}, {"radii", structs, read}};

constexpr Binding place_instances_bindings[] = {{"objects", quad, read},
                                                {"instances", quad, read},
                                                {"instance_lo", quad, write},
                                                {"instance_hi", quad, write},
                                                {"keys", word, write}};

constexpr Binding sort_keys_bindings[] = {{"keys", word, read}, {"sorted", word, write}};

constexpr Binding upper_leaves_bindings[] = {{"keys", word, read},
                                             {"instance_lo", quad, read},
                                             {"instance_hi", quad, read},
                                             {"upper_boxes", quad, write}};

constexpr Binding enter_instances_bindings[] = {{"rays", quad, read},
                                                {"hits", quad, read_write},
                                                {"hit_instances", word, read_write},
                                                {"states", quad, read_write},
                                                {"places", quad, read_write},
                                                {"trails", quad, read_write},
                                                {"steps", word, read_write},
                                                {"upper_boxes", quad, read},
                                                {"keys", word, read},
                                                {"instance_lo", quad, read},
                                                {"instance_hi", quad, read},
                                                {"owners", word, read},
                                                {"local_hits", quad, read},
                                                {"local_steps", word, read},
                                                {"found", word, write},
                                                {"block_counts", structs, read_write}};

constexpr Binding scan_blocks_bindings[] = {
    {"block_counts", structs, read_write}, {"block_starts", word, write}, {"entered", structs, read_write}};

constexpr Binding list_rays_bindings[] = {{"rays", quad, read},         {"hits", quad, read_write},
                                          {"states", quad, read_write}, {"block_counts", structs, read_write},
                                          {"block_starts", word, read}, {"some", word, read},
                                          {"ray_list", word, write},    {"shadow_rays", quad, write}};

constexpr Binding gather_rays_bindings[] = {{"found", word, read},
                                            {"block_starts", word, read},
                                            {"owners", word, read},
                                            {"next_owners", word, write}};

constexpr Binding local_rays_bindings[] = {
    {"rays", quad, read},          {"hits", quad, read},        {"states", quad, read},
    {"places", quad, read},        {"found", word, read},       {"instances", quad, read},
    {"owners", word, read},        {"roots", word, write},      {"local_rays", quad, write},
    {"local_states", quad, write}, {"local_steps", word, write}};

constexpr Binding portion_begin_bindings[] = {{"rays", quad, read},
                                              {"hits", quad, read_write},
                                              {"states", quad, read_write},
                                              {"steps", word, write},
                                              {"found_hits", quad, write}};

constexpr Binding portion_enter_bindings[] = {
    {"rays", quad, read},        {"hits", quad, read},         {"states", quad, read},
    {"runs", word, read},        {"local_rays", quad, write},  {"local_states", quad, write},
    {"local_hits", quad, write}, {"local_steps", word, write}, {"wanted", structs, read_write}};

constexpr Binding portion_end_bindings[] = {{"local_hits", quad, read},
                                            {"local_steps", word, read},
                                            {"hits", quad, read_write},
                                            {"states", quad, read_write},
                                            {"steps", word, read_write},
                                            {"runs", word, read},
                                            {"times", word, read},
                                            {"geometry", quad, read},
                                            {"normal_map", quad, read},
                                            {"texel_map", quad, read},
                                            {"triangles", quad, read},
                                            {"triangle_numbers", word, read},
                                            {"positions", quad, read},
                                            {"normals", quad, read},
                                            {"tangents", quad, read},
                                            {"texcoords", quad, read},
                                            {"charts", quad, read},
                                            {"found_hits", quad, write},
                                            {"found_geometry", quad, write},
                                            {"found_normal_map", quad, write},
                                            {"found_texel_map", quad, write},
                                            {"found_triangles", quad, write},
                                            {"found_positions", quad, write},
                                            {"found_normals", quad, write},
                                            {"found_tangents", quad, write},
                                            {"found_texcoords", quad, write},
                                            {"found_charts", quad, write}};

constexpr Binding boxes_leaves_bindings[] = {
    {"leaf_map", word, read}, {"geometry", quad, read}, {"boxes", quad, write}, {"groups", word, read}};

constexpr Binding boxes_blocks_bindings[] = {
    {"blocks", quad, read}, {"geometry", quad, read}, {"boxes", quad, write}};

constexpr Binding boxes_bindings[] = {{"boxes", quad, read_write}};

// The CPU's.
constexpr Binding wide_nodes_bindings[] = {{"leaf_map", word, read},
                                           {"geometry", quad, read},
                                           {"blocks", quad, read},
                                           {"wide_nodes", structs, write}};

// `placing`: whether it writes cones.
#define SURFACE_BINDINGS_OF(placing)                                                                     \
  {"hits", quad, read}, {"geometry", quad, read}, {"normal_map", quad, read}, {"texel_map", quad, read}, \
      {"triangles", quad, read}, {"positions", quad, read}, {"normals", quad, read},                     \
      {"tangents", quad, read}, {"texcoords", quad, read}, {"images", word, read},                       \
      {"emitter_numbers", word, read}, {"charts", quad, read}, {"parts", structs, read},                 \
      {"materials", structs, read}, {"textures", structs, read}, {"frame", structs, read},               \
      {"ray_words", word, read}, {"placing", quad, placing}, {                                           \
    "collapses", word, read                                                                              \
  }
#define SURFACE_BINDINGS SURFACE_BINDINGS_OF(read)

#define ENVIRONMENT_BINDINGS           \
  {"environment_quads", quad, read}, { \
    "environment_cells", word, read    \
  }

constexpr Binding mask_bindings[] = {SURFACE_BINDINGS,
                                     {"rays", quad, read_write},
                                     {"states", quad, read_write},
                                     {"pending", structs, read_write}};

constexpr Binding shade_bindings[] = {SURFACE_BINDINGS,
                                      {"rays", quad, read},
                                      {"lights", structs, read},
                                      {"contributions", quad, write},
                                      {"shadow_rays", quad, write},
                                      {"radiance", quad, read_write},
                                      ENVIRONMENT_BINDINGS,
                                      {"paths", quad, read},
                                      {"ray_list", word, read}};

constexpr Binding branch_bindings[] = {SURFACE_BINDINGS_OF(read_write),
                                       {"rays", quad, read_write},
                                       {"paths", quad, read_write},
                                       {"branches", quad, read_write},
                                       {"going_on", structs, read_write}};

constexpr Binding ambient_bindings[] = {SURFACE_BINDINGS,
                                        {"rays", quad, read},
                                        {"contributions", quad, write},
                                        {"shadow_rays", quad, write},
                                        {"radiance", quad, read_write}};

constexpr Binding path_bindings[] = {
    SURFACE_BINDINGS_OF(read_write), {"rays", quad, read_write},        {"lights", structs, read},
    {"contributions", quad, write},  {"shadow_rays", quad, write},      {"radiance", quad, read_write},
    {"paths", quad, read_write},     {"going_on", structs, read_write}, ENVIRONMENT_BINDINGS,
    {"drawn_points", quad, read}};

constexpr Binding draw_emitters_bindings[] = {SURFACE_BINDINGS,
                                              {"rays", quad, read},
                                              {"emitter_texels", word, read},
                                              {"emitter_objects", word, read},
                                              {"instance_numbers", word, read},
                                              {"drawn_points", quad, write},
                                              {"ray_list", word, read}};

constexpr Binding aov_bindings[] = {
    SURFACE_BINDINGS, {"rays", quad, read}, {"steps", word, read}, {"aovs", quad, write}};

constexpr Binding features_bindings[] = {
    SURFACE_BINDINGS, {"rays", quad, read}, {"features", quad, read_write}};

#undef ENVIRONMENT_BINDINGS
#undef SURFACE_BINDINGS
#undef SURFACE_BINDINGS_OF

constexpr Binding accumulate_bindings[] = {{"shadow_hits", quad, read},
                                           {"contributions", quad, read},
                                           {"radiance", quad, read_write},
                                           {"ray_list", word, read}};

constexpr Binding resolve_bindings[] = {
    {"frame", structs, read}, {"radiance", quad, read}, {"beauty", quad, write}, {"display", quad, write}};

constexpr Binding denoise_moments_bindings[] = {{"radiance", quad, read}, {"moments", quad, read_write}};

constexpr Binding denoise_begin_bindings[] = {{"frame", structs, read}, {"radiance", quad, read},
                                              {"features", quad, read}, {"moments", quad, read},
                                              {"guides", quad, write},  {"light", quad, write}};

constexpr Binding denoise_filter_bindings[] = {
    {"guides", quad, read}, {"light", quad, read}, {"filtered", quad, write}};

constexpr Binding denoise_end_bindings[] = {{"frame", structs, read}, {"guides", quad, read},
                                            {"light", quad, read},    {"noisy", quad, read},
                                            {"beauty", quad, write},  {"display", quad, write}};

}  // namespace

using namespace layout;

const PassDecl links{"links", "geometry_image/links", links_bindings, sizeof(LinksPush)};
const PassDecl blend{"blend", "geometry_image/blend", blend_bindings, sizeof(BlendPush)};
const PassDecl relax_begin{"relax", "geometry_image/relax_begin", relax_begin_bindings, sizeof(CountPush)};
const PassDecl relax_measure{"relax", "geometry_image/relax_measure", relax_measure_bindings,
                             sizeof(RelaxPush)};
const PassDecl relax_move{"relax", "geometry_image/relax_move", relax_move_bindings, sizeof(RelaxPush)};
const PassDecl rasterise{"rasterise", "geometry_image/rasterise", rasterise_bindings, sizeof(RasterisePush)};
const PassDecl bounds_leaves{"bounds", "geometry_image/bounds_leaves", bounds_leaves_bindings,
                             sizeof(BoundsPush)};
const PassDecl bounds{"bounds", "geometry_image/bounds", bounds_bindings, sizeof(BoundsPush)};
const PassDecl wide_nodes{"bounds", "geometry_image/wide_nodes", wide_nodes_bindings, sizeof(BoxesPush)};
const PassDecl boxes_blocks{"bounds", "geometry_image/boxes_blocks", boxes_blocks_bindings,
                            sizeof(BoxesPush)};
const PassDecl boxes_leaves{"bounds", "geometry_image/boxes_leaves", boxes_leaves_bindings,
                            sizeof(BoxesPush)};
const PassDecl boxes{"bounds", "geometry_image/boxes", boxes_bindings, sizeof(BoxesPush)};
const PassDecl detail_begin{"detail", "geometry_image/detail_begin", detail_begin_bindings,
                            sizeof(CountPush)};
const PassDecl detail_measure{"detail", "geometry_image/detail_measure", detail_measure_bindings,
                              sizeof(DetailPush)};
const PassDecl detail_settle{"detail", "geometry_image/detail_settle", detail_settle_bindings,
                             sizeof(DetailPush)};
const PassDecl detail_end{"detail", "geometry_image/detail_end", detail_end_bindings, sizeof(CountPush)};
const PassDecl place_instances{"upper", "geometry_image/place_instances", place_instances_bindings,
                               sizeof(PlacePush)};
const PassDecl sort_keys{"upper", "geometry_image/sort_keys", sort_keys_bindings, sizeof(SortPush)};
const PassDecl upper_leaves{"upper", "geometry_image/upper_leaves", upper_leaves_bindings, sizeof(BoxesPush)};
const PassDecl upper_boxes{"upper", "geometry_image/boxes", boxes_bindings, sizeof(BoxesPush)};
const PassDecl enter_instances{"trace", "geometry_image/enter_instances", enter_instances_bindings,
                               sizeof(EnterPush)};
const PassDecl scan_blocks{"trace", "geometry_image/scan_blocks", scan_blocks_bindings, sizeof(CountPush)};
const PassDecl list_rays{"trace", "geometry_image/list_rays", list_rays_bindings, sizeof(ListPush)};
const PassDecl list_paths{"shade", "geometry_image/list_rays", list_rays_bindings, sizeof(ListPush)};
const PassDecl scan_paths{"shade", "geometry_image/scan_blocks", scan_blocks_bindings, sizeof(CountPush)};
const PassDecl occlude_list{"occlude", "geometry_image/list_rays", list_rays_bindings, sizeof(ListPush)};
const PassDecl gather_rays{"trace", "geometry_image/gather_rays", gather_rays_bindings, sizeof(GatherPush)};
const PassDecl local_rays{"trace", "geometry_image/local_rays", local_rays_bindings, sizeof(CountPush)};
const PassDecl occlude_enter{"occlude", "geometry_image/enter_instances", enter_instances_bindings,
                             sizeof(EnterPush)};
const PassDecl occlude_scan{"occlude", "geometry_image/scan_blocks", scan_blocks_bindings, sizeof(CountPush)};
const PassDecl occlude_gather{"occlude", "geometry_image/gather_rays", gather_rays_bindings,
                              sizeof(GatherPush)};
const PassDecl occlude_local{"occlude", "geometry_image/local_rays", local_rays_bindings, sizeof(CountPush)};
const PassDecl portion_begin{"trace", "geometry_image/portion_begin", portion_begin_bindings,
                             sizeof(PortionPush)};
const PassDecl portion_enter{"trace", "geometry_image/portion_enter", portion_enter_bindings,
                             sizeof(PortionPush)};
const PassDecl portion_end{"trace", "geometry_image/portion_end", portion_end_bindings, sizeof(PortionPush)};
const PassDecl occlude_portion_begin{"occlude", "geometry_image/portion_begin", portion_begin_bindings,
                                     sizeof(PortionPush)};
const PassDecl occlude_portion_enter{"occlude", "geometry_image/portion_enter", portion_enter_bindings,
                                     sizeof(PortionPush)};
const PassDecl occlude_portion_end{"occlude", "geometry_image/portion_end", portion_end_bindings,
                                   sizeof(PortionPush)};
const PassDecl camera{"camera", "geometry_image/camera", camera_bindings, sizeof(RayPush)};
const PassDecl trace_threaded{"trace", "geometry_image/trace_threaded", trace_threaded_bindings,
                              sizeof(TracePush)};
const PassDecl trace_octant{"trace", "geometry_image/trace_octant", trace_octant_bindings, sizeof(TracePush)};
const PassDecl trace_wide{"trace", "geometry_image/trace_wide", trace_wide_bindings, sizeof(TracePush)};
const PassDecl trace_boxes{"trace", "geometry_image/trace_boxes", trace_boxes_bindings, sizeof(TracePush)};
const PassDecl trace_tile{"trace", "geometry_image/trace_tile", trace_tile_bindings, sizeof(TracePush)};
const PassDecl occlude_threaded{"occlude", "geometry_image/trace_threaded", trace_threaded_bindings,
                                sizeof(TracePush)};
const PassDecl occlude_octant{"occlude", "geometry_image/trace_octant", trace_octant_bindings,
                              sizeof(TracePush)};
const PassDecl occlude_wide{"occlude", "geometry_image/trace_wide", trace_wide_bindings, sizeof(TracePush)};
const PassDecl occlude_boxes{"occlude", "geometry_image/trace_boxes", trace_boxes_bindings,
                             sizeof(TracePush)};
const PassDecl mask{"mask", "geometry_image/mask", mask_bindings, sizeof(CountPush)};
const PassDecl shade{"shade", "geometry_image/shade", shade_bindings, sizeof(RayPush)};
const PassDecl ambient{"shade", "geometry_image/ambient", ambient_bindings, sizeof(AmbientPush)};
const PassDecl branch{"scatter", "geometry_image/branch", branch_bindings, sizeof(BranchPush)};
const PassDecl draw_emitters{"emitters", "geometry_image/draw_emitters", draw_emitters_bindings,
                             sizeof(EmitterPush)};
const PassDecl path{"shade", "geometry_image/path", path_bindings, sizeof(PathPush)};
const PassDecl accumulate{"accumulate", "geometry_image/accumulate", accumulate_bindings, sizeof(CountPush)};
const PassDecl aov{"aov", "geometry_image/aov", aov_bindings, sizeof(RayPush)};
const PassDecl resolve{"resolve", "geometry_image/resolve", resolve_bindings, sizeof(ResolvePush)};
const PassDecl features{"denoise", "geometry_image/features", features_bindings, sizeof(FeaturesPush)};
const PassDecl denoise_moments{"denoise", "denoise/moments", denoise_moments_bindings, sizeof(MomentsPush)};
const PassDecl denoise_begin{"denoise", "denoise/begin", denoise_begin_bindings, sizeof(ResolvePush)};
const PassDecl denoise_variance{"denoise", "denoise/variance", denoise_filter_bindings, sizeof(DenoisePush)};
const PassDecl denoise_filter{"denoise", "denoise/filter", denoise_filter_bindings, sizeof(DenoisePush)};
const PassDecl denoise_end{"denoise", "denoise/end", denoise_end_bindings, sizeof(CountPush)};

}  // namespace lodestone::render::passes
