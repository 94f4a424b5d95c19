// SPDX-License-Identifier: MIT
// From a hit to the surface there: which triangle of the input, where on it, which material, which normal.
// Included by kernels behind the buffers it names, and by the CPU fallback inside a class whose members have
// those names; LOAD4, LOAD1, count_read, and WHERE and SET for what only some invocations do, mean the same
// in both. So do numbers that are the same in the whole dispatch: `sources`, 3 where the atlas has mapped
// charts, `detailed_sources` with levels of detail (layout/detail.h), else 1; `layered`, 1 where a material
// may reflect in another way than metallic-roughness says, be transparent or coated (where that is 0 the
// Surface is a plain one whatever the material says); `instanced`, 1 where an instance puts what was hit into
// the world (layout/objects.h); and `segments`, not 0 where the surface moves while the shutter is open
// (layout/motion.h).

// A point of the input, and its share in what is found at a hit.
struct SurfaceSource {
  uvec1 triangle;  // of the assembly
  vec1 b1;         // barycentrics there
  vec1 b2;
  vec1 share;
  uvec1 vertex[3];
};

// Where a hit lies on the input. On a mapped chart it has three sources, its texels, that with the greatest
// share first (of equal ones the first texel); on others one, and others of no share where there must be
// three. With levels of detail a texel that has slid adds its parent.
struct SurfacePoint {
  uvec1 texel[3];  // of the corners of the triangle that was hit
  vec1 weight[3];
  vec3 corner[3];                          // their positions
  uvec1 parent[3];                         // with levels of detail: the texels that they slide to ...
  vec1 collapse[3];                        // ... and how far they have
  SurfaceSource source[detailed_sources];  // those from `sources` on are not set
  uvec1 part;                              // of the first source
  Moment moment;                           // at which it was hit; not set where nothing moves
  vec4 to_world[3];                        // rows of the instance's matrix; not set without instances
  vec1 rounding;                           // InstanceRecord::rounding
  uvec1 emitter_share;                     // InstanceRecord::emitter_share; not set without instances
  uvec1 emitter;                           // the half that it is of (layout/emitters.h); no_index: of none
};

FN vec3 placed_direction(IN(SurfacePoint) point, vec3 d) {
  return vec3(point.to_world[0].x * d.x + point.to_world[0].y * d.y + point.to_world[0].z * d.z,
              point.to_world[1].x * d.x + point.to_world[1].y * d.y + point.to_world[1].z * d.z,
              point.to_world[2].x * d.x + point.to_world[2].y * d.y + point.to_world[2].z * d.z);
}
FN vec3 placed_point(IN(SurfacePoint) point, vec3 p) {
  return vec3(
      point.to_world[0].x * p.x + point.to_world[0].y * p.y + point.to_world[0].z * p.z + point.to_world[0].w,
      point.to_world[1].x * p.x + point.to_world[1].y * p.y + point.to_world[1].z * p.z + point.to_world[1].w,
      point.to_world[2].x * p.x + point.to_world[2].y * p.y + point.to_world[2].z * p.z +
          point.to_world[2].w);
}
FN vec3 linear_row(vec4 row) {
  return vec3(row.x, row.y, row.z);
}
FN bvec1 is_mirrored(IN(SurfacePoint) point) {
  vec3 cofactors = cross3(linear_row(point.to_world[1]), linear_row(point.to_world[2]));
  return dot3(linear_row(point.to_world[0]), cofactors) < 0.0f;
}
// As `blend` turns normals.
FN vec3 placed_normal(IN(SurfacePoint) point, vec3 normal) {
  vec3 r0 = linear_row(point.to_world[0]);
  vec3 r1 = linear_row(point.to_world[1]);
  vec3 r2 = linear_row(point.to_world[2]);
  vec3 turned =
      vec3(dot3(cross3(r1, r2), normal), dot3(cross3(r2, r0), normal), dot3(cross3(r0, r1), normal));
  return select(is_mirrored(point), turned * -1.0f, turned);
}

// Its vertices, and returns its part.
FN uvec1 find_vertices(INOUT(SurfaceSource) source) {
  uvec4 bits;
  LOAD4(bits, triangles, source.triangle);
  source.vertex[0] = bits.x;
  source.vertex[1] = bits.y;
  source.vertex[2] = bits.z;
  return bits.w;
}

// Before there are vertices.
FN void put_greater_first(INOUT(SurfaceSource) first, INOUT(SurfaceSource) second) {
  bvec1 swap = second.share > first.share;
  uvec1 triangle = first.triangle;
  vec3 rest = vec3(first.b1, first.b2, first.share);
  first.triangle = select(swap, second.triangle, first.triangle);
  first.b1 = select(swap, second.b1, first.b1);
  first.b2 = select(swap, second.b2, first.b2);
  first.share = select(swap, second.share, first.share);
  second.triangle = select(swap, triangle, second.triangle);
  second.b1 = select(swap, rest.x, second.b1);
  second.b2 = select(swap, rest.y, second.b2);
  second.share = select(swap, rest.z, second.share);
}

// What an image says of a texel at a moment.
FN vec3 geometry_at(uvec1 texel, IN(Moment) moment) {
  uvec4 bits;
  if (segments == 0u) {
    LOAD4(bits, geometry, texel);
    return as_vec3(bits);
  }
  uint texels = frames[0].image_texels;
  uvec4 next;
  LOAD4(bits, geometry, moment.segment * texels + texel);
  LOAD4(next, geometry, (moment.segment + 1u) * texels + texel);
  return moved3(as_vec3(bits), as_vec3(next), moment.fraction);
}
FN vec3 normal_at(uvec1 texel, IN(Moment) moment) {
  uvec4 bits;
  if (segments == 0u) {
    LOAD4(bits, normal_map, texel);
    return as_vec3(bits);
  }
  uint texels = frames[0].image_texels;
  uvec4 next;
  LOAD4(bits, normal_map, moment.segment * texels + texel);
  LOAD4(next, normal_map, (moment.segment + 1u) * texels + texel);
  return moved3(as_vec3(bits), as_vec3(next), moment.fraction);
}

// How much coarser than the texels the surface is there: the level of the quad, and how far its corners have
// slid to the next.
FN vec1 detail_of(uvec1 primitive, IN(SurfacePoint) point) {
  if (sources != detailed_sources) return vec1(0.0f);
  vec1 slid_on = point.collapse[0] * point.weight[0] + point.collapse[1] * point.weight[1] +
                 point.collapse[2] * point.weight[2];
  return vec1(ivec1(primitive_level(primitive))) + slid_on;
}

// Its corners slide, and what is found there is a mean of what both texels say.
FN void slide_corners(INOUT(SurfacePoint) point, uvec1 level, uvec1 kind, IN(Tolerance) tolerance) {
  bvec1 plain = level == 0u && kind != chart_mapped;
  for (int i = 0; i < 3; ++i) {
    uvec1 radius;
    LOAD1(point.parent[i], collapses, 2u * point.texel[i]);
    LOAD1(radius, collapses, 2u * point.texel[i] + 1u);
    point.collapse[i] = collapse_of(tolerance_at(tolerance, point.corner[i]), uintBitsToFloat(radius));
    plain = plain && point.collapse[i] == 0.0f;
    point.corner[i] = slid(point.corner[i], geometry_at(point.parent[i], point.moment), point.collapse[i]);
  }
  WHERE(!plain) {
    for (int i = 0; i < 3; ++i) {
      uvec4 own;
      uvec4 other;
      LOAD4(own, texel_map, point.texel[i]);
      LOAD4(other, texel_map, point.parent[i]);
      vec1 share = point.weight[i] * point.collapse[i];
      SET(point.source[i].triangle, own.x);
      SET(point.source[i].b1, uintBitsToFloat(own.y));
      SET(point.source[i].b2, uintBitsToFloat(own.z));
      SET(point.source[i].share, point.weight[i] - share);
      SET(point.source[3 + i].triangle, other.x);
      SET(point.source[3 + i].b1, uintBitsToFloat(other.y));
      SET(point.source[3 + i].b2, uintBitsToFloat(other.z));
      SET(point.source[3 + i].share, share);
    }
  }
}

// What rays tolerate that leave `position`, where a ray with that tolerance has hit.
FN RayCone leaving_cone(IN(SurfacePoint) point, vec3 position, IN(Tolerance) tolerance, vec1 spread) {
  vec1 radius = vec1(0.0f);
  for (int i = 0; i < 3; ++i) {
    radius = max2(radius, distance_to(point.corner[i], position));
    radius = max2(radius, distance_to(geometry_at(point.texel[i], point.moment), position));
  }
  return scattered_cone(tolerance, position, radius * 2.0f, spread);
}

FN SurfacePoint locate(uvec1 primitive, vec1 u, vec1 v, uvec1 instance, IN(Moment) moment,
                       IN(Tolerance) tolerance) {
  SurfacePoint point;
  point.moment = moment;
  uvec1 texel = sources == detailed_sources ? primitive_texel(primitive) : primitive >> 1u;
  bvec1 first_half = (primitive & 1u) == 0u;
  uvec4 bits;
  LOAD4(bits, geometry, texel);
  uvec4 record0;
  uvec4 record1;
  LOAD4(record0, charts, 2u * (bits.w - 1u));
  LOAD4(record1, charts, 2u * (bits.w - 1u) + 1u);
  ChartRecord chart = chart_record(record0, record1);
  uvec1 across = uvec1(1u);
  uvec1 along = chart.width;
  if (sources == detailed_sources) {
    uvec1 row = (texel - chart.first_texel) / chart.width;
    uvec1 column = texel - chart.first_texel - row * chart.width;
    uvec1 size = uvec1(1u) << primitive_level(primitive);
    across = select(column + size < chart.width, size, chart.width - 1u - column);
    along = chart.width * select(row + size < chart.height, size, chart.height - 1u - row);
  }
  point.texel[0] = select(first_half, texel, texel + along + across);
  point.texel[1] = select(first_half, texel + across, texel + along);
  point.texel[2] = select(first_half, texel + along, texel + across);
  point.weight[0] = 1.0f - u - v;
  point.weight[1] = u;
  point.weight[2] = v;
  for (int i = 0; i < 3; ++i) point.corner[i] = geometry_at(point.texel[i], moment);
  point.rounding = 1.0f;
  if (instanced != 0u) {
    for (int i = 0; i < 3; ++i) {
      LOAD4(bits, instances, instance_quads * instance + uint(3 + i));
      point.to_world[i] = as_vec4(bits);
    }
    LOAD4(bits, instances, instance_quads * instance + 6u);
    point.rounding = uintBitsToFloat(bits.z);
    point.emitter_share = bits.w;
    for (int i = 0; i < 3; ++i) point.corner[i] = placed_point(point, point.corner[i]);
  }
  uvec1 emitter = 2u * (chart.first_emitter - 1u + (texel - chart.first_texel)) + (primitive & 1u);
  point.emitter = select(chart.first_emitter == 0u, uvec1(no_index), emitter);
  // On a grid the place in the chart says which triangle it is, else the texel map.
  point.source[0].triangle = chart.first_triangle;
  point.source[0].b1 = u;
  point.source[0].b2 = v;
  point.source[0].share = 1.0f;
  WHERE(chart.kind == chart_grid) {
    uvec1 place = texel - chart.first_texel;
    uvec1 row = place / chart.width;
    SET(point.source[0].triangle, chart.first_triangle + 2u * (place - row) + (primitive & 1u));
  }
  WHERE(chart.kind == chart_exact) {
    uvec4 s0;
    uvec4 s1;
    uvec4 s2;
    LOAD4(s0, texel_map, point.texel[0]);
    LOAD4(s1, texel_map, point.texel[1]);
    LOAD4(s2, texel_map, point.texel[2]);
    SET(point.source[0].triangle, s0.x);
    SET(point.source[0].b1,
        uintBitsToFloat(s0.y) * point.weight[0] + uintBitsToFloat(s1.y) * u + uintBitsToFloat(s2.y) * v);
    SET(point.source[0].b2,
        uintBitsToFloat(s0.z) * point.weight[0] + uintBitsToFloat(s1.z) * u + uintBitsToFloat(s2.z) * v);
  }
  if (sources != 1u) {
    for (uint i = 1u; i < sources; ++i) {
      point.source[i].triangle = point.source[0].triangle;
      point.source[i].b1 = point.source[0].b1;
      point.source[i].b2 = point.source[0].b2;
      point.source[i].share = 0.0f;
    }
    if (sources == detailed_sources) {
      slide_corners(point, primitive_level(primitive), chart.kind, tolerance);
    } else {
      WHERE(chart.kind == chart_mapped) {
        for (int i = 0; i < 3; ++i) {
          LOAD4(bits, texel_map, point.texel[i]);
          SET(point.source[i].triangle, bits.x);
          SET(point.source[i].b1, uintBitsToFloat(bits.y));
          SET(point.source[i].b2, uintBitsToFloat(bits.z));
          SET(point.source[i].share, point.weight[i]);
        }
      }
    }
    for (uint i = 1u; i < sources; ++i) put_greater_first(point.source[0], point.source[i]);
  }
  point.part = find_vertices(point.source[0]);
  for (uint k = 1u; k < sources; ++k) find_vertices(point.source[k]);
  return point;
}

// Exactly the sum where the share is 0, also where that or the value is no finite number or -0.
FN vec4 add_share(vec4 sum, vec4 value, vec1 share) {
  return select(share == 0.0f, sum, sum + value * share);
}

// Both sets of texture coordinates.
FN vec4 texcoords_of(IN(SurfaceSource) source) {
  uvec4 t0;
  uvec4 t1;
  uvec4 t2;
  LOAD4(t0, texcoords, source.vertex[0]);
  LOAD4(t1, texcoords, source.vertex[1]);
  LOAD4(t2, texcoords, source.vertex[2]);
  return as_vec4(t0) * (1.0f - source.b1 - source.b2) + as_vec4(t1) * source.b1 + as_vec4(t2) * source.b2;
}
FN vec4 texcoords_at(IN(SurfacePoint) point) {
  vec4 sum = texcoords_of(point.source[0]) * point.source[0].share;
  for (uint k = 1u; k < sources; ++k)
    sum = add_share(sum, texcoords_of(point.source[k]), point.source[k].share);
  return sum;
}

// A texel as stored; `decode`: colours from sRGB to linear by the table.
FN vec4 texel_color(uvec1 index, bool decode) {
  uvec1 rgba;
  LOAD1(rgba, images, index);
  if (!decode) return unpack_rgba8(rgba);
  uvec1 r;
  uvec1 g;
  uvec1 b;
  LOAD1(r, images, rgba & 255u);
  LOAD1(g, images, (rgba >> 8u) & 255u);
  LOAD1(b, images, (rgba >> 16u) & 255u);
  return vec4(uintBitsToFloat(r), uintBitsToFloat(g), uintBitsToFloat(b), vec1(rgba >> 24u) / 255.0f);
}

FN vec4 sample_texture(uint index, vec4 uvs, bool decode) {
  TextureRecord image = textures[index];
  count_read(16u);
  vec2 uv = transform_texcoord(image, image.texcoord == 0u ? vec2(uvs.x, uvs.y) : vec2(uvs.z, uvs.w));
  TexelPair x = texel_pair(uv.x, image.width, image.wrap_u, image.nearest);
  TexelPair y = texel_pair(uv.y, image.height, image.wrap_v, image.nearest);
  vec4 top = texel_color(image.first_texel + y.first * image.width + x.first, decode) * (1.0f - x.weight) +
             texel_color(image.first_texel + y.first * image.width + x.second, decode) * x.weight;
  vec4 bottom =
      texel_color(image.first_texel + y.second * image.width + x.first, decode) * (1.0f - x.weight) +
      texel_color(image.first_texel + y.second * image.width + x.second, decode) * x.weight;
  return top * (1.0f - y.weight) + bottom * y.weight;
}

FN vec4 vertex_color_of(IN(SurfaceSource) source) {
  uvec4 n0;
  uvec4 n1;
  uvec4 n2;
  LOAD4(n0, normals, source.vertex[0]);
  LOAD4(n1, normals, source.vertex[1]);
  LOAD4(n2, normals, source.vertex[2]);
  return unpack_vertex_color(n0.w) * (1.0f - source.b1 - source.b2) + unpack_vertex_color(n1.w) * source.b1 +
         unpack_vertex_color(n2.w) * source.b2;
}
FN vec4 vertex_color_at(IN(SurfacePoint) point) {
  vec4 sum = vertex_color_of(point.source[0]) * point.source[0].share;
  for (uint k = 1u; k < sources; ++k)
    sum = add_share(sum, vertex_color_of(point.source[k]), point.source[k].share);
  return sum;
}

// Base colour and alpha: factor, texture, vertex colour.
FN vec4 base_color_at(IN(MaterialRecord) material, IN(SurfacePoint) point, vec4 uvs) {
  vec4 color = material.base_color;
  if (material.base_color_texture != no_index)
    color = color * sample_texture(material.base_color_texture, uvs, true);
  return color * vertex_color_at(point);
}

// The mesh's own tangent and the bitangent sign of the first vertex.
FN vec4 tangent_of(IN(SurfaceSource) source) {
  uvec4 t0;
  uvec4 t1;
  uvec4 t2;
  LOAD4(t0, tangents, source.vertex[0]);
  LOAD4(t1, tangents, source.vertex[1]);
  LOAD4(t2, tangents, source.vertex[2]);
  vec3 own = as_vec3(t0) * (1.0f - source.b1 - source.b2) + as_vec3(t1) * source.b1 + as_vec3(t2) * source.b2;
  return vec4(own.x, own.y, own.z, uintBitsToFloat(t0.w));
}

// Tangent and bitangent sign at the point: the mesh's own, else along u of texture coordinate set `set` in
// the first source's triangle, on the side of `normal`.
FN vec4 tangent_at(IN(SurfacePoint) point, uint set, vec3 normal) {
  vec4 first = tangent_of(point.source[0]);
  vec4 sum = first * point.source[0].share;
  for (uint k = 1u; k < sources; ++k)
    sum = add_share(sum, tangent_of(point.source[k]), point.source[k].share);
  vec3 own = vec3(sum.x, sum.y, sum.z);
  vec4 tangent = vec4(own.x, own.y, own.z, first.w);
  if (instanced != 0u) {
    vec3 along = placed_direction(point, own);
    tangent = vec4(along.x, along.y, along.z, select(is_mirrored(point), first.w * -1.0f, first.w));
  }
  WHERE(!(dot3(own, own) > 1e-12f)) {
    uvec4 t0;
    uvec4 t1;
    uvec4 t2;
    LOAD4(t0, texcoords, point.source[0].vertex[0]);
    LOAD4(t1, texcoords, point.source[0].vertex[1]);
    LOAD4(t2, texcoords, point.source[0].vertex[2]);
    vec4 d1 = as_vec4(t1) - as_vec4(t0);
    vec4 d2 = as_vec4(t2) - as_vec4(t0);
    vec2 uv1 = set == 0u ? vec2(d1.x, d1.y) : vec2(d1.z, d1.w);
    vec2 uv2 = set == 0u ? vec2(d2.x, d2.y) : vec2(d2.z, d2.w);
    uvec4 p0;
    uvec4 p1;
    uvec4 p2;
    LOAD4(p0, positions, point.source[0].vertex[0]);
    LOAD4(p1, positions, point.source[0].vertex[1]);
    LOAD4(p2, positions, point.source[0].vertex[2]);
    vec3 e1 = as_vec3(p1) - as_vec3(p0);
    vec3 e2 = as_vec3(p2) - as_vec3(p0);
    if (instanced != 0u) {
      e1 = placed_direction(point, e1);
      e2 = placed_direction(point, e2);
    }
    vec1 area = uv1.x * uv2.y - uv1.y * uv2.x;
    vec3 along = e1 * uv2.y - e2 * uv1.y;
    vec3 down = e2 * uv1.x - e1 * uv2.x;
    vec1 side = select(area < 0.0f, -1.0f, 1.0f);
    // glTF's v runs down and a normal map's green up.
    vec1 bitangent = select(dot3(cross3(normal, along), down) > 0.0f, -1.0f, 1.0f);
    SET(tangent, vec4(along.x * side, along.y * side, along.z * side, bitangent));
  }
  return tangent;
}

// `normal` as the normal map `map` bends it.
FN vec3 bent_normal(uint map, float scale, IN(SurfacePoint) point, vec4 uvs, vec3 normal) {
  vec4 tangent = tangent_at(point, textures[map].texcoord, normal);
  vec3 t = vec3(tangent.x, tangent.y, tangent.z);
  t = normalize_or(t - normal * dot3(normal, t), vec3(0.0f, 0.0f, 0.0f));
  vec3 b = cross3(normal, t) * tangent.w;
  vec4 texel = sample_texture(map, uvs, false);
  vec3 bent = t * ((texel.x * 2.0f - 1.0f) * scale) + b * ((texel.y * 2.0f - 1.0f) * scale) +
              normal * (texel.z * 2.0f - 1.0f);
  return normalize_or(bent, normal);
}

// `s.normal` is that of the vertices, and neither normal is turned to the viewer yet.
FN void add_layers(INOUT(Surface) s, IN(MaterialRecord) material, IN(SurfacePoint) point, vec4 uvs) {
  count_read(20u);
  // Not by the order of the vertices, which a mirroring node turns round.
  vec1 outward = select(dot3(s.geometric, s.normal) < 0.0f, -1.0f, 1.0f);
  s.inside = outward * dot3(s.geometric, s.view) < 0.0f;
  s.ior = material.ior;
  s.solid = material.solid != 0u;
  s.attenuation = material.attenuation;
  s.f90 = material.specular;
  if (material.specular_texture != no_index)
    s.f90 = s.f90 * sample_texture(material.specular_texture, uvs, false).w;
  vec3 tint = material.specular_color;
  if (material.specular_color_texture != no_index) {
    vec4 texel = sample_texture(material.specular_color_texture, uvs, true);
    tint = tint * vec3(texel.x, texel.y, texel.z);
  }
  s.f0 = min3(tint * material.f0, vec3(1.0f, 1.0f, 1.0f)) * s.f90;
  s.transmission = material.transmission;
  if (material.transmission_texture != no_index)
    s.transmission = s.transmission * sample_texture(material.transmission_texture, uvs, false).x;
  s.clearcoat = material.clearcoat;
  if (material.clearcoat_texture != no_index)
    s.clearcoat = s.clearcoat * sample_texture(material.clearcoat_texture, uvs, false).x;
  s.clearcoat_roughness = material.clearcoat_roughness;
  if (material.clearcoat_roughness_texture != no_index) {
    vec1 texel = sample_texture(material.clearcoat_roughness_texture, uvs, false).y;
    s.clearcoat_roughness = s.clearcoat_roughness * texel;
  }
  s.clearcoat_normal = s.normal;
  if (material.clearcoat_normal_texture != no_index) {
    s.clearcoat_normal =
        bent_normal(material.clearcoat_normal_texture, material.clearcoat_normal_scale, point, uvs, s.normal);
  }
}

FN vec3 corner_normal(IN(SurfacePoint) point, int i) {
  vec3 own = normal_at(point.texel[i], point.moment);
  if (sources != detailed_sources) return own;
  vec3 other = normal_at(point.parent[i], point.moment);
  return select(point.collapse[i] == 0.0f, own, mix3(own, other, point.collapse[i]));
}

// Position and geometric normal, which is not turned to the viewer yet.
FN void set_place(INOUT(Surface) s, IN(SurfacePoint) point) {
  s.position = point.corner[0] * point.weight[0] + point.corner[1] * point.weight[1] +
               point.corner[2] * point.weight[2];
  s.reach = largest_abs(s.position);
  for (int i = 0; i < 3; ++i) s.reach = max2(s.reach, largest_abs(point.corner[i] - s.position));
  if (instanced != 0u) {
    vec3 moved = vec3(point.to_world[0].w, point.to_world[1].w, point.to_world[2].w);
    s.reach = max2(s.reach, largest_abs(moved)) * point.rounding;
  }
  vec3 across = cross3(point.corner[1] - point.corner[0], point.corner[2] - point.corner[0]);
  s.geometric = normalize_or(across, s.view);
}

FN vec3 emission_at(IN(MaterialRecord) material, vec4 uvs) {
  vec3 emission = material.emissive;
  if (material.emissive_texture != no_index) {
    vec4 texel = sample_texture(material.emissive_texture, uvs, true);
    emission = emission * vec3(texel.x, texel.y, texel.z);
  }
  return emission;
}

// With which density by area a point of the triangle is drawn as an emitter (layout/emitters.h).
FN vec1 drawn_density(IN(SurfacePoint) point) {
  vec1 density = 0.0f;
  WHERE(point.emitter != no_index) {
    uvec1 first;
    uvec1 next;
    LOAD1(first, emitter_numbers, point.emitter);
    LOAD1(next, emitter_numbers, point.emitter + 1u);
    vec1 chance = vec1(next - first) / drawn_numbers;
    if (instanced != 0u) chance = chance * (vec1(point.emitter_share) / drawn_numbers);
    vec3 across = flush_tiny3(cross3(point.corner[1] - point.corner[0], point.corner[2] - point.corner[0]));
    vec1 area = 0.5f * sqrt(dot3(across, across));
    SET(density, select(area > 0.0f, flush_lost(chance / area), vec1(0.0f)));
  }
  return density;
}

FN Surface surface_at(IN(MaterialRecord) material, IN(SurfacePoint) point, vec3 from_viewer) {
  Surface s;
  vec4 uvs = texcoords_at(point);
  s.texcoord = vec2(uvs.x, uvs.y);
  s.view = from_viewer * -1.0f;
  set_place(s, point);
  vec3 n0 = corner_normal(point, 0);
  vec3 n1 = corner_normal(point, 1);
  vec3 n2 = corner_normal(point, 2);
  s.normal = n0 * point.weight[0] + n1 * point.weight[1] + n2 * point.weight[2];
  if (instanced != 0u) s.normal = placed_normal(point, s.normal);
  s.normal = normalize_or(s.normal, s.geometric);
  vec4 base = base_color_at(material, point, uvs);
  s.albedo = vec3(base.x, base.y, base.z);
  s.alpha = base.w;
  s.metallic = saturate(material.metallic);
  s.roughness = saturate(material.roughness);
  if (material.metallic_roughness_texture != no_index) {
    vec4 texel = sample_texture(material.metallic_roughness_texture, uvs, false);
    s.roughness = s.roughness * texel.y;
    s.metallic = s.metallic * texel.z;
  }
  s.occlusion = 1.0f;
  if (material.occlusion_texture != no_index) {
    vec1 texel = sample_texture(material.occlusion_texture, uvs, false).x;
    s.occlusion = 1.0f + material.occlusion_strength * (texel - 1.0f);
  }
  s.emission = emission_at(material, uvs);
  if (layered != 0u) add_layers(s, material, point, uvs);
  if (material.normal_texture != no_index)
    s.normal = bent_normal(material.normal_texture, material.normal_scale, point, uvs, s.normal);
  // Both sides are lit alike: turn the normals to the viewer, the shading normal with the geometric one.
  s.geometric = select(dot3(s.geometric, s.view) < 0.0f, s.geometric * -1.0f, s.geometric);
  s.normal = select(dot3(s.normal, s.geometric) < 0.0f, s.normal * -1.0f, s.normal);
  if (layered == 0u) {
    make_plain(s);
  } else {
    s.clearcoat_normal =
        select(dot3(s.clearcoat_normal, s.geometric) < 0.0f, s.clearcoat_normal * -1.0f, s.clearcoat_normal);
  }
  return s;
}
