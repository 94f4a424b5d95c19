// SPDX-License-Identifier: MIT
// Baked atlases as bytes; atlas.h has the functions that read and write files.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "lodestone/geometry_image/atlas.h"

namespace lodestone::geometry_image {

std::vector<std::byte> pack_atlas(const Atlas& atlas, const BakeRecord& record);

// Any bytes whatever give an atlas that keeps every promise, or Error(bad_input) that names `file`.
Atlas unpack_atlas(const std::string& file, std::span<const std::byte> bytes, BakeRecord* record);

}  // namespace lodestone::geometry_image
