// SPDX-License-Identifier: MIT
// Motion blur as the command line has it, and what the shutter sees of a frame.
#pragma once

#include <algorithm>
#include <vector>

#include "lodestone/app/common_options.h"
#include "lodestone/app/prepared_scene.h"
#include "lodestone/render/renderer.h"

namespace lodestone::app {

struct ShutterOptions {
  double open = 0;        // frames; 0: an instant
  uint32_t segments = 0;  // as given; 0: not given

  // render::Settings::shutter_segments.
  uint32_t settled_segments() const { return open > 0 ? std::max(segments, 1u) : 0; }
};

// --shutter --shutter-segments
void add_shutter_options(CLI::App& app, ShutterOptions& options);

// Has the scene made one object where something is to move, for instances do not. Throws Error(usage) where
// segments are given and no shutter.
void settle_shutter(const ShutterOptions& options, SceneOptions& scene);

// The moments of the frame at the wrapped time `seconds`, which is in the middle; empty without motion. A
// clip is not looped within a frame: before its beginning and past its end nothing moves.
std::vector<render::Moment> shutter_moments(const ShutterOptions& options, const PreparedScene& prepared,
                                            const PictureOptions& picture, const scene::Bounds& bounds,
                                            double seconds, double fps);

}  // namespace lodestone::app
