// SPDX-License-Identifier: MIT
// What the report of an atlas says in words.
#pragma once

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/triangle_survey.h"

namespace lodestone::geometry_image {

// Fills in the counts that the survey gives, and a note for each kind of fault that there is, naming the
// first case.
void report_survey(const scene::Scene& scene, const scene::Assembly& assembly, const TriangleSurvey& survey,
                   AtlasReport& report);

}  // namespace lodestone::geometry_image
