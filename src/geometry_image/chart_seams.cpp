// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_seams.h"

#include <algorithm>
#include <cmath>

#include "lodestone/base/disjoint_sets.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::face_of;
using base_complex::HalfEdgeMesh;
using base_complex::next;

class SeamFinder {
 public:
  SeamFinder(const scene::Scene& scene, const scene::Assembly& assembly,
             const std::vector<uint32_t>& triangles, HalfEdgeMesh& mesh)
      : assembly_(assembly), triangles_(triangles), mesh_(mesh), seams_count_(assembly.parts.size(), true) {
    judge_seams(scene);
  }

  void run() {
    std::vector<uint32_t> creases;
    for (uint32_t h = 0; h < 3 * mesh_.faces(); ++h) {
      const uint32_t twin = mesh_.twin(h);
      if (twin == base_complex::none || twin < h) continue;
      if (is_part_border(h, twin) || (seams_count_[triangle_of(h).w] && is_seam(h, twin))) {
        mesh_.make_barrier(h);
      } else if (is_crease(h, twin)) {
        creases.push_back(h);
      }
    }
    keep_long(creases);
  }

 private:
  const glm::uvec4& triangle_of(uint32_t h) const { return assembly_.triangles[triangles_[face_of(h)]]; }
  uint32_t vertex_at(uint32_t h) const { return triangle_of(h)[static_cast<glm::length_t>(h % 3)]; }

  bool is_part_border(uint32_t h, uint32_t twin) const { return triangle_of(h).w != triangle_of(twin).w; }
  bool is_seam(uint32_t h, uint32_t twin) const {
    return differ(vertex_at(h), vertex_at(next(twin))) || differ(vertex_at(next(h)), vertex_at(twin));
  }
  bool differ(uint32_t a, uint32_t b) const {
    if (a == b) return false;
    return assembly_.texcoords[0][a] != assembly_.texcoords[0][b] ||
           assembly_.texcoords[1][a] != assembly_.texcoords[1][b] ||
           assembly_.colors[a] != assembly_.colors[b];
  }

  // Texture coordinates that differ at every other edge, in a part without a texture, are no atlas that
  // anybody made: to cut there would leave nothing whole.
  void judge_seams(const scene::Scene& scene) {
    constexpr uint64_t too_often = 4;
    std::vector<uint64_t> edges(assembly_.parts.size(), 0), seams(assembly_.parts.size(), 0);
    for (uint32_t h = 0; h < 3 * mesh_.faces(); ++h) {
      const uint32_t twin = mesh_.twin(h);
      if (twin == base_complex::none || twin < h || is_part_border(h, twin)) continue;
      ++edges[triangle_of(h).w];
      seams[triangle_of(h).w] += is_seam(h, twin) ? 1 : 0;
    }
    for (size_t p = 0; p < seams_count_.size(); ++p) {
      seams_count_[p] = has_texture(scene, assembly_.parts[p]) || too_often * seams[p] <= edges[p];
    }
  }

  // The faces or the normals for shading turn by more than a smooth surface of these triangles would.
  bool is_crease(uint32_t h, uint32_t twin) const {
    constexpr double sharp_faces = 0.5, sharp_normals = 0.9;  // cosines of 60 and 25 degrees
    const glm::dvec3 n0 = mesh_.normal(face_of(h)), n1 = mesh_.normal(face_of(twin));
    if (n0 == glm::dvec3(0) || n1 == glm::dvec3(0)) return false;
    if (glm::dot(n0, n1) < sharp_faces) return true;
    return normals_differ(vertex_at(h), vertex_at(next(twin)), sharp_normals) ||
           normals_differ(vertex_at(next(h)), vertex_at(twin), sharp_normals);
  }
  bool normals_differ(uint32_t a, uint32_t b, double cosine) const {
    return a != b && glm::dot(glm::dvec3(assembly_.normals[a]), glm::dvec3(assembly_.normals[b])) < cosine;
  }

  // Noise makes short creases everywhere: what counts is connected and long, measured by the surface that it
  // is part of. Between smooth surfaces much less is enough, as for the rim of a small hole in a large plate.
  void keep_long(const std::vector<uint32_t>& creases) {
    constexpr double long_enough = 0.1, long_enough_if_clean = 0.005, mostly = 0.5;
    DisjointSets connected(mesh_.points());
    for (const uint32_t h : creases) connected.join(mesh_.from(h), mesh_.to(h));
    std::vector<double> length(mesh_.points(), 0), clean(mesh_.points(), 0);
    for (const uint32_t h : creases) {
      const uint32_t name = connected.find(mesh_.from(h));
      length[name] += mesh_.length(h);
      if (is_smooth_beside(h) && is_smooth_beside(mesh_.twin(h))) clean[name] += mesh_.length(h);
    }
    const std::vector<double> size = sizes();
    for (const uint32_t h : creases) {
      const uint32_t name = connected.find(mesh_.from(h));
      const double least = clean[name] >= mostly * length[name] ? long_enough_if_clean : long_enough;
      if (length[name] >= least * size[face_of(h)]) mesh_.make_barrier(h);
    }
  }

  // Whether the surface is smooth or ends at the two other edges of the face, but for creases as sharp as
  // those.
  bool is_smooth_beside(uint32_t half_edge) const {
    constexpr double smooth = 0.94;  // cosine of 20 degrees
    for (uint32_t h = next(half_edge); h != half_edge; h = next(h)) {
      const uint32_t twin = mesh_.twin(h);
      if (twin == base_complex::none || is_crease(h, twin)) continue;
      if (glm::dot(mesh_.normal(face_of(h)), mesh_.normal(face_of(twin))) < smooth) return false;
    }
    return true;
  }

  // Of each face the root of the area that is connected to it.
  std::vector<double> sizes() const {
    DisjointSets connected(mesh_.faces());
    for (uint32_t h = 0; h < 3 * mesh_.faces(); ++h)
      if (mesh_.twin(h) != base_complex::none) connected.join(face_of(h), face_of(mesh_.twin(h)));
    std::vector<double> area(mesh_.faces(), 0), sizes(mesh_.faces());
    for (uint32_t f = 0; f < mesh_.faces(); ++f) area[connected.find(f)] += mesh_.area(f);
    for (uint32_t f = 0; f < mesh_.faces(); ++f) sizes[f] = std::sqrt(area[connected.find(f)]);
    return sizes;
  }

  const scene::Assembly& assembly_;
  const std::vector<uint32_t>& triangles_;
  HalfEdgeMesh& mesh_;
  std::vector<bool> seams_count_;  // of each part, whether its texture seams are to be arcs
};

}  // namespace

bool has_texture(const scene::Scene& scene, const scene::AssemblyPart& part) {
  if (part.material == scene::none) return false;
  const auto textures = scene.materials[part.material].textures();
  return std::any_of(textures.begin(), textures.end(),
                     [](const scene::Texture* t) { return t->image != scene::none; });
}

void mark_seams(const scene::Scene& scene, const scene::Assembly& assembly,
                const std::vector<uint32_t>& triangles, HalfEdgeMesh& mesh) {
  SeamFinder(scene, assembly, triangles, mesh).run();
}

}  // namespace lodestone::geometry_image
