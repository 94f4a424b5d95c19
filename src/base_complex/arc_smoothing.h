// SPDX-License-Identifier: MIT
// Arcs follow edges of the mesh, in zigzag where it is not regular. What is sampled about as closely as that
// gets ragged borders: so samples of arcs that are not firm move to where a smooth line would be.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/base_complex/base_complex.h"

namespace lodestone::base_complex {

struct PlaceOnFace {
  uint32_t face = none;        // of the mesh
  glm::dvec3 barycentrics{0};  // none below 0, about 1 in all
};

class ArcSmoother {
 public:
  explicit ArcSmoother(const BaseComplex& complex);  // must outlive it

  // Of each of the places, distances along the arc in ascending order, where on the surface it goes: to the
  // point nearest to the arc's mean between the places before and behind it, on a face at the arc. No face
  // where it stays: at both ends, on firm arcs and where a firm one is too near.
  std::vector<PlaceOnFace> smooth(uint32_t arc, const std::vector<double>& places) const;

 private:
  PlaceOnFace nearest_face(const Arc& arc, size_t first, size_t end, const glm::dvec3& point) const;

  const BaseComplex& complex_;
  std::vector<uint32_t> first_, faces_;  // of each point that is on an arc, the faces around it
};

}  // namespace lodestone::base_complex
