// SPDX-License-Identifier: MIT
// What is drawn at random by weight gets a run of 2^24 numbers each; a random number is one of them, and a
// binary search finds whose (layout/environment.h, layout/draw_emitter.h).
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace lodestone::render {

inline constexpr uint32_t drawn_numbers = 1u << 24;

// Shares the numbers out by `weights`, none of which may be negative: how many come before each, and all in
// the end; `first` is one longer. Every weight above 0 gets at least one number, unless these are more than
// there are numbers. Where all are 0 each counts as 1.
void share_out(std::span<const double> weights, std::span<uint32_t> first);

// Where a binary search among `count` begins: the greatest power of 2 below it; 0: none.
inline uint32_t greatest_step(uint32_t count) {
  return count < 2 ? 0 : std::bit_floor(count - 1);
}

}  // namespace lodestone::render
