// SPDX-License-Identifier: MIT
#include "lodestone/kernels/kernels.h"

#include <algorithm>

namespace lodestone::kernels {

std::span<const uint32_t> find_kernel(std::span<const Kernel> set, std::string_view name) {
  const auto found =
      std::lower_bound(set.begin(), set.end(), name,
                       [](const Kernel& kernel, std::string_view key) { return kernel.name < key; });
  return found == set.end() || found->name != name ? std::span<const uint32_t>() : found->words;
}

}  // namespace lodestone::kernels
