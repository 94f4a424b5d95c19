// SPDX-License-Identifier: MIT
#include "lodestone/render/number_shares.h"

#include <algorithm>

#include "lodestone/layout/frame.h"

namespace lodestone::render {

static_assert(drawn_numbers == static_cast<uint32_t>(layout::drawn_numbers));

void share_out(std::span<const double> weights, std::span<uint32_t> first) {
  const bool nothing = std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0; });
  const auto weight = [&](size_t i) { return nothing ? 1 : weights[i]; };
  double total = 0;
  uint64_t lit = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    total += weight(i);
    lit += weight(i) > 0 ? 1 : 0;
  }
  const bool all_get_one = lit <= drawn_numbers;
  const auto left = static_cast<double>(all_get_one ? drawn_numbers - lit : drawn_numbers);
  double before = 0;
  uint32_t lit_before = 0;
  for (size_t i = 0; i <= weights.size(); ++i) {
    // In the end `before` is `total`, for both are the same sum.
    first[i] = lit_before + static_cast<uint32_t>(before / total * left);
    if (i == weights.size()) break;
    before += weight(i);
    lit_before += all_get_one && weight(i) > 0 ? 1 : 0;
  }
}

}  // namespace lodestone::render
