// SPDX-License-Identifier: MIT
// The edges that charts must not cross: where the surface carries something that is one-sided (another part
// or texture seam) and where it has a crease.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/half_edge_mesh.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::geometry_image {

// Whether its material has one; if not, changes of texture coordinates may count for nothing.
bool has_texture(const scene::Scene& scene, const scene::AssemblyPart& part);

// Makes barriers of the seams of a mesh whose face f is triangle `triangles[f]` of the assembly.
void mark_seams(const scene::Scene& scene, const scene::Assembly& assembly,
                const std::vector<uint32_t>& triangles, base_complex::HalfEdgeMesh& mesh);

}  // namespace lodestone::geometry_image
