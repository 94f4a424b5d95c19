// SPDX-License-Identifier: MIT
// The atlas: which charts there are, which point of the surface each texel samples, and where each quad
// stands in the hierarchy. Static per scene and resolution; shaders/layout/atlas.h declares the buffers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "lodestone/geometry_image/chart_maps.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::geometry_image {

enum class AtlasKind : uint32_t { automatic, grid, exact, charts };

// Where a resampled surface gets more texels: spread evenly over its area, or more where it bends, or where
// it looks larger from the cameras of the scene.
enum class Signal : uint32_t { area, curvature, screen };

// How surfaces that have no grid of their own are resampled.
struct ChartSettings {
  uint64_t texel_budget = 0;  // for all such surfaces together; 0: about one a triangle
  Signal signal = Signal::area;
  bool all_shapes =
      false;               // what any morph target stretches gets texels for that; else the rest pose decides
  bool keep_maps = false;  // Atlas::maps; they change nothing else
  friend bool operator==(const ChartSettings&, const ChartSettings&) = default;
};

struct AtlasSettings {
  AtlasSettings(AtlasKind kind_of_charts = AtlasKind::automatic) : kind(kind_of_charts) {}
  AtlasKind kind;
  ChartSettings charts;
  friend bool operator==(const AtlasSettings&, const AtlasSettings&) = default;
};

// What was found in the input and what was done about it; printed by `info` and `-v`.
struct AtlasReport {
  uint64_t triangles = 0;  // of the assembly, dropped ones included
  uint64_t quads = 0, texels = 0, slots = 0;
  // Of zero area in the rest pose: dropped, but for those that a pose can open and those that seal a gap.
  uint64_t degenerate_triangles = 0;
  // Of the same three welded vertices in the same cyclic order: the first is kept.
  uint64_t duplicate_triangles = 0;
  uint64_t non_manifold_edges = 0;  // more than two triangles: kept
  uint64_t boundary_edges = 0;      // one triangle
  uint64_t welded_vertices = 0;     // joined to a lower one that is the same point in every pose
  uint64_t mapped_triangles = 0;    // represented by resampled charts ...
  uint64_t mapped_charts = 0;       // ... this many of them
  uint64_t repeated_texels = 0;     // on borders of mapped charts, where the chart beside them is coarser
  // L2 stretch of mapped charts in the rest pose, over the area of the surface: 1 where a map is an isometry
  // up to the mean density of texels. The mean, and what 95 % of the area keep below; of several objects the
  // mean over their areas, each in its own space, and the largest.
  double mean_stretch = 0, high_stretch = 0;
  std::vector<std::string> notes;  // one sentence each
  bool closed() const { return boundary_edges == 0 && non_manifold_edges == 0; }
};

// The part of an atlas that is an object's (scene/assembly.h): a hierarchy of its own.
struct AtlasObject {
  uint32_t depth = 0;  // the leaves' level: 4^depth >= slots
  uint32_t first_slot = 0, slots = 0;
  uint32_t first_texel = 0, texels = 0;
};

struct Atlas {
  AtlasKind kind = AtlasKind::exact;  // what the charts are; automatic: some of each kind
  std::vector<AtlasObject> objects;   // in the order of the assembly
  // Object by object, and of each in the order of mesh and triangle, mapped ones behind all others; texels
  // ascend with them. Blocks of slots are aligned within their object.
  std::vector<layout::ChartRecord> charts;
  std::vector<glm::uvec4> texel_map;  // see layout/atlas.h
  std::vector<glm::uvec2> leaf_map;   // one a slot; an object's slots end with its last chart's block
  ChartMaps maps;                     // of all mapped charts, or empty
  AtlasReport report;
};

// Told the name of each stage of the work as it begins.
using OnStage = std::function<void(const char*)>;

// `grid` needs every placed mesh to be made of grids (else Error(usage)); `exact` gives every triangle a
// chart; `charts` resamples everything, and keeps as exact only what it cannot map; `automatic` takes grid
// where meshes are made of them and resamples the rest (one atlas can hold charts of all kinds). Objects are
// charted one by one, and errors told in parts of their own size; a texel budget is shared out by the area
// that their largest instances have in the rest pose. Throws Error(bad_input) where no triangle is left, a
// grid is not what scene.h says, or more texels or leaves are needed than there can be.
Atlas build_atlas(const scene::Scene& scene, const scene::Assembly& assembly, const AtlasSettings& settings,
                  const OnStage& on_stage = {});

// What an atlas was baked from.
struct BakeRecord {
  std::string content_hash{};  // atlas_hash() of the scene
  // builtin:NAME, or the scene's file as a path relative to the folder of the baked file; empty: not recorded
  // (so in the cache).
  std::string scene{};
  float height_scale = 0;                                 // scene::LoadOptions::height_scale
  AtlasSettings asked{};                                  // what build_atlas was given, and the hash with it
  scene::Instancing instancing = scene::Instancing::off;  // that of the assembly
};

// Baked files (.lode): header (magic, version, record, sizes), then the arrays zstd-compressed, then a
// checksum.
void save_atlas(const std::filesystem::path& path, const Atlas& atlas, const BakeRecord& record);
// Throws Error(bad_input) unless the file is whole, of this version, consistent in every index. Whether it is
// the atlas of a given scene is for the caller to see: by the hash, and by report.triangles. The path in the
// record is what the file says: open it through scene::AssetFolder only.
Atlas load_atlas(const std::filesystem::path& path, BakeRecord* record = nullptr);

// The key of the cache: everything that the atlas is computed from.
std::string atlas_hash(const scene::Scene& scene, const scene::Assembly& assembly,
                       const AtlasSettings& settings);

// From the cache folder ($LODESTONE_CACHE, else $XDG_CACHE_HOME/lodestone, else ~/.cache/lodestone) or built
// and put there; a damaged or unwritable cache costs a note, never the run. `hit`: whether it was there.
Atlas cached_atlas(const scene::Scene& scene, const scene::Assembly& assembly, const AtlasSettings& settings,
                   bool* hit = nullptr, const OnStage& on_stage = {});

}  // namespace lodestone::geometry_image
