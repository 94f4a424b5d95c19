// SPDX-License-Identifier: MIT
// Every pass, under the name of its kernel; what each does stands in shaders/geometry_image/NAME.comp.
#pragma once

#include "lodestone/cpu_fallback/kernel.h"

namespace lodestone::cpu_fallback {

void links(const CpuDispatch& dispatch);
void blend(const CpuDispatch& dispatch);
void relax_begin(const CpuDispatch& dispatch);
void relax_measure(const CpuDispatch& dispatch);
void relax_move(const CpuDispatch& dispatch);
void rasterise(const CpuDispatch& dispatch);
void bounds_leaves(const CpuDispatch& dispatch);
void bounds(const CpuDispatch& dispatch);
void boxes_leaves(const CpuDispatch& dispatch);
void boxes(const CpuDispatch& dispatch);
void detail_begin(const CpuDispatch& dispatch);
void detail_measure(const CpuDispatch& dispatch);
void detail_settle(const CpuDispatch& dispatch);
void detail_end(const CpuDispatch& dispatch);
void place_instances(const CpuDispatch& dispatch);
void sort_keys(const CpuDispatch& dispatch);
void upper_leaves(const CpuDispatch& dispatch);
void enter_instances(const CpuDispatch& dispatch);
void scan_blocks(const CpuDispatch& dispatch);
void gather_rays(const CpuDispatch& dispatch);
void list_rays(const CpuDispatch& dispatch);
void local_rays(const CpuDispatch& dispatch);
void portion_begin(const CpuDispatch& dispatch);
void portion_enter(const CpuDispatch& dispatch);
void portion_end(const CpuDispatch& dispatch);
void camera(const CpuDispatch& dispatch);
void trace_threaded(const CpuDispatch& dispatch);
void trace_octant(const CpuDispatch& dispatch);
void trace_boxes(const CpuDispatch& dispatch);
void trace_tile(const CpuDispatch& dispatch);
void mask(const CpuDispatch& dispatch);
void shade(const CpuDispatch& dispatch);
void ambient(const CpuDispatch& dispatch);
void branch(const CpuDispatch& dispatch);
void draw_emitters(const CpuDispatch& dispatch);
void path(const CpuDispatch& dispatch);
void accumulate(const CpuDispatch& dispatch);
void aov(const CpuDispatch& dispatch);
void resolve(const CpuDispatch& dispatch);
void features(const CpuDispatch& dispatch);
void denoise_moments(const CpuDispatch& dispatch);
void denoise_begin(const CpuDispatch& dispatch);
void denoise_variance(const CpuDispatch& dispatch);
void denoise_filter(const CpuDispatch& dispatch);
void denoise_end(const CpuDispatch& dispatch);

}  // namespace lodestone::cpu_fallback
