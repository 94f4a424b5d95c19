// SPDX-License-Identifier: MIT
// What an atlas is like, in a few lines for people.
#pragma once

#include <optional>
#include <string>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/fidelity.h"

namespace lodestone::app {

std::string atlas_text(const std::string& name, const geometry_image::Atlas& atlas,
                       const std::optional<geometry_image::Fidelity>& fidelity);

// Of 100 texels of mapped charts, those that do not repeat their neighbour.
double texels_used(const geometry_image::Atlas& atlas);

}  // namespace lodestone::app
