// SPDX-License-Identifier: MIT
#include "lodestone/render/geometry_image.h"

#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/layout/frame.h"
#include "lodestone/render/passes.h"

namespace lodestone::render {
namespace {

std::optional<Detail> make_detail(Backend& device, const scene::Assembly& assembly,
                                  const geometry_image::Atlas& atlas, const Settings& settings,
                                  const std::vector<uint32_t>& first_emitters) {
  if (settings.pixels_of_error == 0) return {};
  if (assembly.has_instances())
    fail(ExitCode::usage, "--pixels-of-error", "is not for instances; give --instancing off");
  if (settings.shutter_segments > 0)
    fail(ExitCode::usage, "--pixels-of-error", "does not go together with --shutter; give one of them");
  return std::optional<Detail>(std::in_place, device, assembly, atlas, first_emitters);
}

uint64_t image_texels(const geometry_image::Atlas& atlas, const Settings& settings) {
  const uint64_t images = settings.shutter_segments + 1, texels = atlas.texel_map.size();
  if (images * texels > std::numeric_limits<int32_t>::max()) {
    fail(ExitCode::usage, "--shutter-segments", "{} geometry images of {} texels are too many; give fewer",
         images, texels);
  }
  return images * texels;
}

}  // namespace

GeometryImage::GeometryImage(Backend& backend, const scene::Assembly& assembly,
                             const geometry_image::Atlas& atlas, const Settings& settings,
                             const std::vector<uint32_t>& first_emitters)
    : backend_(backend),
      tables_(backend, assembly, atlas, first_emitters),
      objects_(assembly.objects),
      atlas_objects_(atlas.objects),
      has_tangents_(assembly.has_tangents),
      texels_(static_cast<uint32_t>(atlas.texel_map.size())),
      sweeps_(settings.relaxation_sweeps),
      detail_(make_detail(backend, assembly, atlas, settings, first_emitters)),
      tracing_(backend, atlas, tables_.leaf_map, settings.traversal,
               uint64_t(settings.width) * settings.height, settings.loop_budget, settings.shutter_segments,
               detail_ ? &*detail_ : nullptr) {
  const uint64_t vertices = assembly.positions.size(), texels = image_texels(atlas, settings);
  weights_ = Buffer(backend, {"weights", assembly.weight_count, 4});
  matrices_ = Buffer(backend, {"matrices", 3 * uint64_t(assembly.matrix_count), 16});
  positions_ = Buffer(backend, {"positions", vertices, 16});
  normals_ = Buffer(backend, {"normals", vertices, 16});
  tangents_ = Buffer(backend, {"tangents", vertices, 16});
  geometry_ = Buffer(backend, {"geometry", texels, 16});
  normal_map_ = Buffer(backend, {"normal_map", texels, 16});
}

template <class Push>
void GeometryImage::run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push,
                        uint32_t invocations) {
  backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), invocations, {}});
}

void GeometryImage::relax(const geometry_image::Atlas& atlas, const PosedVertices& rest,
                          const std::string& name) {
  if (atlas.maps.empty()) {
    fail(ExitCode::usage, "--relaxation-sweeps",
         "needs the maps of the charts, and the atlas of {} has none; bake it with --keep-maps", name);
  }
  // By the same pass as every pose, so that the rest pose has stretched nothing, to the bit.
  Buffer rest_positions(backend_, backend_.desc(positions_.id()));
  blend(rest, rest_positions);
  relaxation_.emplace(backend_, tables_, atlas, std::move(rest_positions));
}

void GeometryImage::set_camera(const layout::RayCone& camera) {
  camera_ = camera;
  tracing_.set_camera(camera);
}

void GeometryImage::blend(const PosedVertices& vertices, const Buffer& positions) {
  if (!vertices.weights.empty()) backend_.upload(weights_.id(), std::as_bytes(std::span(vertices.weights)));
  backend_.upload(matrices_.id(), std::as_bytes(std::span(vertices.matrices)));
  // What is rigid has been blended once and for all.
  uint32_t first = 0;
  for (const scene::Object& object : objects_)
    if (rigid_done_ && object.rigid) first = object.first_vertex + object.vertices;
  const auto count = static_cast<uint32_t>(backend_.desc(positions_.id()).elements) - first;
  if (count == 0) return;
  run(passes::blend,
      {tables_.base_positions.id(), tables_.base_normals.id(), tables_.base_tangents.id(),
       tables_.vertex_ranges.id(), tables_.morph_positions.id(), tables_.morph_normals.id(),
       tables_.morph_tangents.id(), tables_.influences.id(), weights_.id(), matrices_.id(), positions.id(),
       normals_.id(), tangents_.id()},
      layout::BlendPush{first, count, has_tangents_ ? 1u : 0u}, count);
}

// Of the blended vertices; the geometry image begins at texel `image`.
void GeometryImage::rasterise(uint32_t first_texel, uint32_t image) {
  const uint32_t texels = texels_ - first_texel;
  if (texels == 0) return;
  run(passes::rasterise,
      {texel_map(), tables_.triangles.id(), positions_.id(), normals_.id(), geometry_.id(), normal_map_.id()},
      layout::RasterisePush{first_texel, texels, image}, texels);
}

void GeometryImage::update(const PosedVertices& pose, const std::vector<PosedVertices>& shutter,
                           const std::vector<scene::Bounds>& boxes, const std::vector<scene::Bounds>& whole) {
  if (relaxation_ || shutter.empty()) blend(pose, positions_);
  if (relaxation_) relaxation_->run(positions_.id(), sweeps_);
  if (!shutter.empty()) {  // a geometry image a moment, and a hierarchy for each two of them
    for (uint32_t i = 0; i < shutter.size(); ++i) {
      blend(shutter[i], positions_);
      rasterise(0, i * texels_);
    }
    blend(pose, positions_);  // what shading looks up itself
    tracing_.build(geometry_, boxes, whole, 0);
    return;
  }
  size_t first = 0;  // object to be made anew
  uint32_t first_texel = 0;
  while (rigid_done_ && first < objects_.size() && objects_[first].rigid) {
    first_texel = atlas_objects_[first].first_texel + atlas_objects_[first].texels;
    ++first;
  }
  rasterise(first_texel, 0);
  if (detail_) detail_->build(geometry_, steepest_cone(camera_));
  tracing_.build(geometry_, boxes, whole, first);
  rigid_done_ = true;
}

SurfaceBuffers GeometryImage::buffers() const {
  return {geometry_.id(),         normal_map_.id(),       texel_map(),
          tables_.triangles.id(), positions_.id(),        normals_.id(),
          tangents_.id(),         tables_.texcoords.id(), tables_.charts.id()};
}

BufferId GeometryImage::texel_map() const {
  return relaxation_ ? relaxation_->texel_map() : tables_.texel_map.id();
}

}  // namespace lodestone::render
