// SPDX-License-Identifier: MIT
// The camera of a frame in its picture, so that a pixel and its depth give back the point that it shows.
#pragma once

#include "lodestone/image/image.h"
#include "lodestone/render/renderer.h"

namespace lodestone::app {

// Sets image.camera, and as text:
//   lodestone:camera_to_world  4 x 4 numbers, row by row, for column vectors; the camera looks along its
//                              -Z, +X is right and +Y up in the picture
//   lodestone:projection       `perspective half_width=W half_height=H`, of what is seen at distance 1
//                              along the axis, or `orthographic ...`, in units of the scene
// The centre of pixel (x, y), counted from the upper left, is at ((2 x + 1) / width - 1) W to the right and
// (1 - (2 y + 1) / height) H upwards.
void add_camera(const render::View& view, image::Image& image);

}  // namespace lodestone::app
