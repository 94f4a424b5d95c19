// SPDX-License-Identifier: MIT
// The atlas: which charts there are, which point of the surface each texel samples, and where each quad
// stands in the hierarchy. Static per scene and resolution; shaders/layout/atlas.h declares the buffers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "lodestone/layout/atlas.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::geometry_image {

enum class AtlasKind : uint32_t { automatic, grid, exact };

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
  std::vector<std::string> notes;   // one sentence each
  bool closed() const { return boundary_edges == 0 && non_manifold_edges == 0; }
};

struct Atlas {
  AtlasKind kind = AtlasKind::exact;        // what the charts are; automatic: some of each kind
  uint32_t depth = 0;                       // the leaves' level: 4^depth >= slot count
  std::vector<layout::ChartRecord> charts;  // in the order of mesh and triangle; texels ascend with them
  std::vector<glm::uvec4> texel_map;        // see layout/atlas.h
  std::vector<glm::uvec2> leaf_map;         // one a slot; the slots end with the last chart's block
  AtlasReport report;
};

// `grid` needs every placed mesh to be made of grids (else Error(usage)); `automatic` takes grid where they
// are, exact for the rest (one atlas can hold charts of both kinds). Throws Error(bad_input) where no
// triangle is left, a grid is not what scene.h says, or more texels or leaves are needed than there can be.
Atlas build_atlas(const scene::Scene& scene, const scene::Assembly& assembly, AtlasKind kind);

// What an atlas was baked from.
struct BakeRecord {
  std::string content_hash{};  // atlas_hash() of the scene
  // builtin:NAME, or the scene's file as a path relative to the folder of the baked file; empty: not recorded
  // (so in the cache).
  std::string scene{};
  float height_scale = 0;                  // scene::LoadOptions::height_scale
  AtlasKind asked = AtlasKind::automatic;  // what build_atlas was given, and the hash with it
};

// Baked files (.lode): header (magic, version, record, sizes), then the arrays zstd-compressed, then a
// checksum.
void save_atlas(const std::filesystem::path& path, const Atlas& atlas, const BakeRecord& record);
// Throws Error(bad_input) unless the file is whole, of this version, consistent in every index. Whether it is
// the atlas of a given scene is for the caller to see: by the hash, and by report.triangles. The path in the
// record is what the file says: open it through scene::AssetFolder only.
Atlas load_atlas(const std::filesystem::path& path, BakeRecord* record = nullptr);

// The key of the cache: everything that the atlas is computed from.
std::string atlas_hash(const scene::Scene& scene, const scene::Assembly& assembly, AtlasKind kind);

// From the cache folder ($LODESTONE_CACHE, else $XDG_CACHE_HOME/lodestone, else ~/.cache/lodestone) or built
// and put there; a damaged or unwritable cache costs a note, never the run. `hit`: whether it was there.
Atlas cached_atlas(const scene::Scene& scene, const scene::Assembly& assembly, AtlasKind kind,
                   bool* hit = nullptr);

}  // namespace lodestone::geometry_image
