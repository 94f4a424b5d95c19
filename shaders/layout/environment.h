// SPDX-License-Identifier: MIT
// The environment: radiance from a direction, and directions by their share of the light (Pharr, Jakob and
// Humphreys 2023, "Physically Based Rendering", 4th edition, 12.5). Included by kernels behind the buffers it
// names, and by the CPU fallback inside a class whose members have those names (environment_kernel-inl.h):
//
//   environment_quads   height + 2 rows { first number, polar distance at its upper and its lower border,
//                       density by number (float bits) }, the last one without a row behind it; then, of a
//                       map, its texels, row by row { R, G, B (float bits), 0 }
//   environment_cells   height + 1 times width + 1 words: the first number of each cell of a row
//   frames              one FrameRecord, whose `environment` says how large the others are
//
// `environment_map`, the same in the whole dispatch, is 0 for the analytic sky, 1 for a map: equirectangular,
// the upper row around +Y, its columns from -X by -Z, +X and +Z back to -X. So a direction of unit length is
// at
//
//   u = turn + atan2(z, x) / (2 pi), with turn = 1/2 for a map that is not rotated, and v = acos(y) / pi
//
// of the width and the height, as in three.js, and in Blender for scenes that its glTF importer has read.
//
// A cell lies between the centres of four texels (of two at the poles), which is where radiance is one
// bilinear patch: width x (height + 1) of them, those of the first and the last row half as high. The density
// of directions is the mean luminance of the four corners times the cell's solid angle, and the same in the
// whole cell: so it is 0 only where all of the patch is black. Numbers are 24 bits: the rows share 2^24 of
// them, and so do the cells of each row, and none that has light goes without; one number is one number of
// `xi`.

struct EnvironmentSample {
  vec3 direction;  // unit length
  vec1 pdf;        // by solid angle, above 0
};

// The bilinear patch around a direction.
struct EnvironmentPlace {
  uvec1 column;  // of the cell, and of its left texels
  uvec1 row;     // of the cell; of its upper texels, plus 1
  vec1 right;    // weight of the right texels
  vec1 lower;    // weight of the lower ones
};

// Of a direction of any length; the zero vector counts as +Y.
FN EnvironmentPlace environment_place(vec3 direction) {
  EnvironmentRecord environment = frames[0].environment;
  vec1 u = environment.turn + atan2_turns(direction.z, direction.x);
  vec1 v = 2.0f * atan2_turns(sqrt(direction.x * direction.x + direction.z * direction.z), direction.y);
  vec1 x = (u - floor(u)) * float(environment.width) - 0.5f;
  vec1 y = v * float(environment.height) - 0.5f;
  vec1 whole_x = floor(x);
  vec1 whole_y = floor(y);
  EnvironmentPlace place;
  place.right = x - whole_x;
  place.lower = y - whole_y;
  ivec1 column = ivec1(whole_x);
  place.column = uvec1(select(column < 0, int(environment.width) - 1, column));
  place.row = uvec1(ivec1(whole_y) + 1);
  return place;
}

FN vec3 environment_texel(uvec1 column, uvec1 row) {
  uvec4 texel;
  LOAD4(texel, environment_quads,
        frames[0].environment.height + 2u + row * frames[0].environment.width + column);
  return as_vec3(texel);
}

// From where a ray of this direction goes to: W / (sr m2).
FN vec3 environment_radiance(vec3 direction) {
  if (environment_map == 0u) return sky_radiance(frames[0], direction);
  uint width = frames[0].environment.width;
  uint height = frames[0].environment.height;
  EnvironmentPlace place = environment_place(direction);
  uvec1 right = select(place.column + 1u < width, place.column + 1u, 0u);
  uvec1 upper = select(place.row < 1u, 0u, place.row - 1u);
  uvec1 lower = select(place.row < height, place.row, height - 1u);
  vec3 top = environment_texel(place.column, upper) * (1.0f - place.right) +
             environment_texel(right, upper) * place.right;
  vec3 bottom = environment_texel(place.column, lower) * (1.0f - place.right) +
                environment_texel(right, lower) * place.right;
  return top * (1.0f - place.lower) + bottom * place.lower;
}

// The density by solid angle with which sample_environment chooses the cell around the direction. At a
// border, where rounding may put what it has chosen into the cell beside it, sample_environment has the true
// one.
FN vec1 environment_pdf(vec3 direction) {
  EnvironmentPlace place = environment_place(direction);
  uvec1 cell = place.row * (frames[0].environment.width + 1u) + place.column;
  uvec4 row;
  uvec1 first;
  uvec1 next;
  LOAD4(row, environment_quads, place.row);
  LOAD1(first, environment_cells, cell);
  LOAD1(next, environment_cells, cell + 1u);
  return vec1(next - first) * uintBitsToFloat(row.w);
}

// Where a number lies among those from `first` to before `next`: the middle of its place, in (0, 1].
FN vec1 environment_share(uvec1 number, uvec1 first, uvec1 next) {
  return (vec1(number - first) + 0.5f) / vec1(next - first);
}

// A direction for `xi` in [0, 1)^2, of which 24 bits count; y chooses the row, and what neighbours in `xi`
// choose are mostly neighbours.
FN EnvironmentSample sample_environment(vec2 xi) {
  EnvironmentRecord environment = frames[0].environment;
  uint width = environment.width;
  uint last_row = environment.height;
  uvec1 number_x = uvec1(xi.x * drawn_numbers);
  uvec1 number_y = uvec1(xi.y * drawn_numbers);
  // The last row that begins at or before the number, and the last cell that does.
  uvec1 row = uvec1(0u);
  for (uint step = environment.row_step; step != 0u; step = step >> 1u) {
    uvec1 place = select(row + step < last_row, row + step, last_row);
    uvec4 bits;
    LOAD4(bits, environment_quads, place);
    row = select(number_y >= bits.x, place, row);
  }
  uvec1 first_cell = row * (width + 1u);
  uvec1 column = uvec1(0u);
  for (uint step = environment.column_step; step != 0u; step = step >> 1u) {
    uvec1 place = select(column + step < width, column + step, width - 1u);
    uvec1 first;
    LOAD1(first, environment_cells, first_cell + place);
    column = select(number_x >= first, place, column);
  }
  uvec4 above;
  uvec4 below;
  uvec1 left;
  uvec1 right;
  LOAD4(above, environment_quads, row);
  LOAD4(below, environment_quads, row + 1u);
  LOAD1(left, environment_cells, first_cell + column);
  LOAD1(right, environment_cells, first_cell + column + 1u);
  vec1 across = environment_share(number_x, left, right);
  vec1 down = environment_share(number_y, above.x, below.x);
  // Evenly by solid angle: by the distance from the nearer pole along the axis, which keeps its bits there.
  vec1 upper = uintBitsToFloat(above.y);
  vec1 lower = uintBitsToFloat(above.z);
  vec1 polar = upper + (lower - upper) * down;
  vec1 radius = sqrt(polar * (2.0f - polar));
  vec1 height = 1.0f - polar;
  vec1 negated = -height;
  vec2 turn = cos_sin_turns((vec1(column) + 0.5f + across) / float(width) - environment.turn);
  EnvironmentSample result;
  result.direction =
      normalize_or(vec3(radius * turn.x, select(row + row < last_row + 1u, height, negated), radius * turn.y),
                   vec3(0.0f, 1.0f, 0.0f));
  result.pdf = vec1(right - left) * uintBitsToFloat(above.w);
  return result;
}
