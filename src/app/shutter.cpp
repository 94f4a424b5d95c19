// SPDX-License-Identifier: MIT
#include "lodestone/app/shutter.h"

#include <fmt/format.h>

#include <algorithm>

#include "lodestone/app/parse_values.h"
#include "lodestone/base/error.h"
#include "lodestone/layout/motion.h"

namespace lodestone::app {
namespace {

constexpr double longest_shutter = 100;  // frames

}  // namespace

void add_shutter_options(CLI::App& app, ShutterOptions& options) {
  add_value(
      app, "--shutter", "FRAMES",
      "Motion blur: the shutter is open for so many frames, 0.5 for half of one, with the frame's time in "
      "the middle (default: 0, an instant)",
      [&](const std::string& text) { options.open = parse_number("--shutter", text, 0, longest_shutter); });
  add_value(app, "--shutter-segments", "N",
            fmt::format("With --shutter: move along N straight lines while it is open (1 to {}, default: 1)",
                        layout::most_segments),
            [&](const std::string& text) {
              options.segments = uint32_t(parse_count("--shutter-segments", text, 1, layout::most_segments));
            });
}

void settle_shutter(const ShutterOptions& options, SceneOptions& scene) {
  if (options.settled_segments() > 0) {
    scene.one_object = "--shutter";
  } else if (options.segments > 0) {
    fail(ExitCode::usage, "--shutter-segments", "does nothing without --shutter; give that too");
  }
}

std::vector<render::Moment> shutter_moments(const ShutterOptions& options, const PreparedScene& prepared,
                                            const PictureOptions& picture, const scene::Bounds& bounds,
                                            double seconds, double fps) {
  std::vector<render::Moment> moments;
  const uint32_t segments = options.settled_segments();
  if (segments == 0) return moments;
  const double last =
      prepared.animation == scene::none ? 0 : prepared.scene.animations[prepared.animation].duration();
  for (uint32_t i = 0; i <= segments; ++i) {
    const double at = seconds + options.open / fps * (double(i) / segments - 0.5);
    render::Moment& moment = moments.emplace_back();
    moment.pose = prepared.pose_at(std::clamp(at, 0.0, last));
    moment.view = view_of(prepared, moment.pose, picture, bounds);
  }
  return moments;
}

}  // namespace lodestone::app
