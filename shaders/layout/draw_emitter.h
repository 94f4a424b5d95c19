// SPDX-License-Identifier: MIT
// Drawing a point of a surface that shines (layout/emitters.h). Included behind layout/surface.h and the
// buffers:
//
//   emitter_numbers   a word a half: the first of the numbers that draw it; ascending within an object
//   emitter_texels    a word an emitter: the texel, in the geometry image that surface.h reads
//   emitter_objects   two words an object: its first half, and the one behind its last
//   instance_numbers  a word an instance: the first of the numbers that draw it

// A random point; `which` draws instance and triangle, `xi` the point there.
FN SurfacePoint draw_emitter(IN(EmitterPush) among, vec2 which, vec2 xi, IN(Moment) moment) {
  uvec1 instance = uvec1(0u);
  uvec1 object = uvec1(0u);
  uvec4 bits;
  if (instanced != 0u) {
    uvec1 number = uvec1(which.x * drawn_numbers);
    for (uint step = among.instance_step; step != 0u; step = step >> 1u) {
      uvec1 place = instance + step;
      place = select(place < among.instances, place, among.instances - 1u);
      uvec1 first;
      LOAD1(first, instance_numbers, place);
      instance = select(number >= first, place, instance);
    }
    LOAD4(bits, instances, instance_quads * instance + 6u);
    object = bits.x;
  }
  uvec1 half_number;
  uvec1 end;
  LOAD1(half_number, emitter_objects, 2u * object);
  LOAD1(end, emitter_objects, 2u * object + 1u);
  uvec1 number = uvec1(which.y * drawn_numbers);
  for (uint step = among.half_step; step != 0u; step = step >> 1u) {
    uvec1 place = half_number + step;
    place = select(place < end, place, end - 1u);
    uvec1 first;
    LOAD1(first, emitter_numbers, place);
    half_number = select(number >= first, place, half_number);
  }
  uvec1 texel;
  LOAD1(texel, emitter_texels, half_number >> 1u);
  vec1 root = sqrt(xi.x);
  // A chart that shines has no levels of detail: nothing there depends on what a ray tolerates.
  Tolerance none;
  none.camera = no_cone();
  none.scattered = no_cone();
  return locate(2u * texel + (half_number & 1u), 1.0f - root, root * xi.y, instance, moment, none);
}

// What shines there.
FN DrawnPoint drawn_point(IN(MaterialRecord) material, IN(SurfacePoint) point) {
  Surface s;
  s.view = vec3(0.0f, 0.0f, 1.0f);
  set_place(s, point);
  vec4 uvs = texcoords_at(point);
  DrawnPoint drawn = nothing_drawn();
  drawn.position = s.position;
  drawn.density = drawn_density(point);
  drawn.normal = s.geometric;
  drawn.offset = s.reach * leaving_offset;
  drawn.emission = emission_at(material, uvs);
  if (material.alpha_mask != 0u) {
    bvec1 cut_out = base_color_at(material, point, uvs).w < material.alpha_cutoff;
    drawn.emission = select(cut_out, vec3(0.0f, 0.0f, 0.0f), drawn.emission);
  }
  if (layered != 0u) {
    Surface whole = surface_at(material, point, s.geometric * -1.0f);
    drawn.coat = whole.clearcoat;
    drawn.coat_normal = whole.clearcoat_normal;
  }
  return drawn;
}
