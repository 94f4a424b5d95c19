// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/arc_errors.h"

#include <algorithm>
#include <bit>

#include "lodestone/base/parallel.h"
#include "lodestone/base_complex/arc_places.h"

namespace lodestone::geometry_image {
namespace {

// Tried are 1 to 8 segments, then four numbers an octave: 10, 12, 14, 16, 20 ...
constexpr uint32_t all_to = 8, an_octave = 4, most_tried = 1u << 11;

uint32_t tried(uint32_t index) {
  if (index < all_to) return index + 1;
  const uint32_t octave = (index - all_to) / an_octave, step = (index - all_to) % an_octave + 1;
  return (an_octave + step) << (octave + 1);
}

// The last one that has no more segments.
uint32_t index_of(uint32_t segments) {
  if (segments <= all_to) return segments - 1;
  const auto octave = static_cast<uint32_t>(std::bit_width(segments)) - 4;
  return all_to - 1 + octave * an_octave + (segments >> (octave + 1)) - an_octave;
}

}  // namespace

ArcErrors::ArcErrors(const base_complex::BaseComplex& complex) : errors_(complex.arcs.size()) {
  constexpr uint64_t arcs_a_task = 16;
  constexpr double nothing = 1e-5;  // of the length
  parallel_for(complex.arcs.size(), arcs_a_task, [&](uint64_t begin, uint64_t end) {
    for (auto arc = static_cast<uint32_t>(begin); arc < end; ++arc) {
      for (uint32_t i = 0; tried(i) <= most_tried; ++i) {
        errors_[arc].push_back(base_complex::arc_error(complex, arc, tried(i)));
        if (errors_[arc].back() <= nothing * complex.arcs[arc].length) break;
      }
    }
  });
}

double ArcErrors::error(uint32_t arc, uint32_t segments) const {
  const std::vector<double>& errors = errors_[arc];
  return errors.empty() ? 0.0 : errors[std::min<size_t>(index_of(segments), errors.size() - 1)];
}

}  // namespace lodestone::geometry_image
