// SPDX-License-Identifier: MIT
// One rendered picture and its values.
#pragma once

#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {

// Linear, with the channels that the settings ask for, through the scene's own camera.
image::Image picture(render::Backend& backend, const ReadyScene& ready, float time,
                     const render::Settings& settings);

float value(const image::Image& image, const char* channel, uint32_t x, uint32_t y);

}  // namespace lodestone::test
