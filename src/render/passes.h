// SPDX-License-Identifier: MIT
// The passes of the geometry-image tracer, declared: kernel, buffers, access. Back ends derive everything
// else from this.
#pragma once

#include "lodestone/render/backend.h"

namespace lodestone::render::passes {

extern const PassDecl links, blend, relax_begin, relax_measure, relax_move, rasterise, bounds_leaves, bounds,
    wide_nodes, boxes_blocks, boxes_leaves, boxes;
extern const PassDecl detail_begin, detail_measure, detail_settle, detail_end;
extern const PassDecl place_instances, sort_keys, upper_leaves, upper_boxes;
extern const PassDecl enter_instances, scan_blocks, gather_rays, local_rays, list_rays, occlude_list,
    list_paths, scan_paths;
extern const PassDecl portion_begin, portion_enter, portion_end, occlude_portion_begin, occlude_portion_enter,
    occlude_portion_end;
extern const PassDecl occlude_enter, occlude_scan, occlude_gather, occlude_local;
extern const PassDecl camera, trace_threaded, trace_octant, trace_wide, trace_boxes, trace_tile,
    occlude_threaded, occlude_octant, occlude_wide, occlude_boxes;
extern const PassDecl mask, shade, ambient, branch, draw_emitters, path, accumulate, aov, resolve;
extern const PassDecl features, denoise_moments, denoise_begin, denoise_variance, denoise_filter, denoise_end;

}  // namespace lodestone::render::passes
