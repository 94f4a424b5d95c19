// SPDX-License-Identifier: MIT
// What the program holds through `new`, libraries included: linking this file replaces the global operators.
#pragma once

#include <cstddef>

namespace lodestone {

// Bytes held at most since the last call of reset_peak().
size_t peak_allocation();
// Starts to count anew from what is held now.
void reset_peak();
// Bytes held now.
size_t current_allocation();

}  // namespace lodestone
