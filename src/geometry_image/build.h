// SPDX-License-Identifier: MIT
// Building an atlas with every choice open, for measurements.
#pragma once

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/chart_order.h"

namespace lodestone::geometry_image {

Atlas build_atlas(const scene::Scene& scene, const scene::Assembly& assembly, const AtlasSettings& settings,
                  ChartOrder order, const OnStage& on_stage = {});

}  // namespace lodestone::geometry_image
