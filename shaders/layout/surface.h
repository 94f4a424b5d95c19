// SPDX-License-Identifier: MIT
// From a hit to the surface there: which triangle of the input, where on it, which material, which normal.
// Included by kernels behind the buffers it names, and by the CPU fallback inside a class whose members have
// those names; LOAD4, LOAD1, count_read, and WHERE and SET for what only some invocations do, mean the same
// in both.

// Where a hit lies on the input.
struct SurfacePoint {
  uvec1 texel[3];  // of the corners of the triangle that was hit
  vec1 weight[3];
  vec3 corner[3];  // their positions
  uvec1 triangle;  // of the assembly
  vec1 b1;         // barycentrics there
  vec1 b2;
  uvec1 vertex[3];
  uvec1 part;
};

FN SurfacePoint locate(uvec1 primitive, vec1 u, vec1 v) {
  SurfacePoint point;
  uvec1 texel = primitive >> 1u;
  bvec1 first_half = (primitive & 1u) == 0u;
  uvec4 bits;
  LOAD4(bits, geometry, texel);
  uvec4 record0;
  uvec4 record1;
  LOAD4(record0, charts, 2u * (bits.w - 1u));
  LOAD4(record1, charts, 2u * (bits.w - 1u) + 1u);
  ChartRecord chart = chart_record(record0, record1);
  point.texel[0] = select(first_half, texel, texel + chart.width + 1u);
  point.texel[1] = select(first_half, texel + 1u, texel + chart.width);
  point.texel[2] = select(first_half, texel + chart.width, texel + 1u);
  point.weight[0] = 1.0f - u - v;
  point.weight[1] = u;
  point.weight[2] = v;
  for (int i = 0; i < 3; ++i) {
    LOAD4(bits, geometry, point.texel[i]);
    point.corner[i] = as_vec3(bits);
  }
  // On a grid the place in the chart says which triangle it is, else the texel map.
  point.triangle = chart.first_triangle;
  point.b1 = u;
  point.b2 = v;
  WHERE(chart.kind == chart_grid) {
    uvec1 place = texel - chart.first_texel;
    uvec1 row = place / chart.width;
    SET(point.triangle, chart.first_triangle + 2u * (place - row) + (primitive & 1u));
  }
  WHERE(chart.kind != chart_grid) {
    uvec4 s0;
    uvec4 s1;
    uvec4 s2;
    LOAD4(s0, texel_map, point.texel[0]);
    LOAD4(s1, texel_map, point.texel[1]);
    LOAD4(s2, texel_map, point.texel[2]);
    SET(point.triangle, s0.x);
    SET(point.b1,
        uintBitsToFloat(s0.y) * point.weight[0] + uintBitsToFloat(s1.y) * u + uintBitsToFloat(s2.y) * v);
    SET(point.b2,
        uintBitsToFloat(s0.z) * point.weight[0] + uintBitsToFloat(s1.z) * u + uintBitsToFloat(s2.z) * v);
  }
  LOAD4(bits, triangles, point.triangle);
  point.vertex[0] = bits.x;
  point.vertex[1] = bits.y;
  point.vertex[2] = bits.z;
  point.part = bits.w;
  return point;
}

// Both sets of texture coordinates at the point.
FN vec4 texcoords_at(IN(SurfacePoint) point) {
  uvec4 t0;
  uvec4 t1;
  uvec4 t2;
  LOAD4(t0, texcoords, point.vertex[0]);
  LOAD4(t1, texcoords, point.vertex[1]);
  LOAD4(t2, texcoords, point.vertex[2]);
  return as_vec4(t0) * (1.0f - point.b1 - point.b2) + as_vec4(t1) * point.b1 + as_vec4(t2) * point.b2;
}

// A texel as stored; `decode`: colours from sRGB to linear by the table.
FN vec4 texel_color(uvec1 index, bool decode) {
  uvec1 rgba;
  LOAD1(rgba, images, index);
  if (!decode) return unpack_rgba8(rgba);
  uvec1 r;
  uvec1 g;
  uvec1 b;
  LOAD1(r, srgb_table, rgba & 255u);
  LOAD1(g, srgb_table, (rgba >> 8u) & 255u);
  LOAD1(b, srgb_table, (rgba >> 16u) & 255u);
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

// Base colour and alpha: factor, texture, vertex colour.
FN vec4 base_color_at(IN(MaterialRecord) material, IN(SurfacePoint) point, vec4 uvs) {
  vec4 color = material.base_color;
  if (material.base_color_texture != no_index)
    color = color * sample_texture(material.base_color_texture, uvs, true);
  uvec4 n0;
  uvec4 n1;
  uvec4 n2;
  LOAD4(n0, normals, point.vertex[0]);
  LOAD4(n1, normals, point.vertex[1]);
  LOAD4(n2, normals, point.vertex[2]);
  return color * (unpack_vertex_color(n0.w) * (1.0f - point.b1 - point.b2) +
                  unpack_vertex_color(n1.w) * point.b1 + unpack_vertex_color(n2.w) * point.b2);
}

// Tangent and bitangent sign at the point: the mesh's own, else along u of texture coordinate set `set`, on
// the side of `normal`.
FN vec4 tangent_at(IN(SurfacePoint) point, uint set, vec3 normal) {
  uvec4 t0;
  uvec4 t1;
  uvec4 t2;
  LOAD4(t0, tangents, point.vertex[0]);
  LOAD4(t1, tangents, point.vertex[1]);
  LOAD4(t2, tangents, point.vertex[2]);
  vec3 own = as_vec3(t0) * (1.0f - point.b1 - point.b2) + as_vec3(t1) * point.b1 + as_vec3(t2) * point.b2;
  vec4 tangent = vec4(own.x, own.y, own.z, uintBitsToFloat(t0.w));
  WHERE(!(dot3(own, own) > 1e-12f)) {
    LOAD4(t0, texcoords, point.vertex[0]);
    LOAD4(t1, texcoords, point.vertex[1]);
    LOAD4(t2, texcoords, point.vertex[2]);
    vec4 d1 = as_vec4(t1) - as_vec4(t0);
    vec4 d2 = as_vec4(t2) - as_vec4(t0);
    vec2 uv1 = set == 0u ? vec2(d1.x, d1.y) : vec2(d1.z, d1.w);
    vec2 uv2 = set == 0u ? vec2(d2.x, d2.y) : vec2(d2.z, d2.w);
    uvec4 p0;
    uvec4 p1;
    uvec4 p2;
    LOAD4(p0, positions, point.vertex[0]);
    LOAD4(p1, positions, point.vertex[1]);
    LOAD4(p2, positions, point.vertex[2]);
    vec3 e1 = as_vec3(p1) - as_vec3(p0);
    vec3 e2 = as_vec3(p2) - as_vec3(p0);
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

FN Surface surface_at(IN(MaterialRecord) material, IN(SurfacePoint) point, vec3 from_viewer) {
  Surface s;
  vec4 uvs = texcoords_at(point);
  s.texcoord = vec2(uvs.x, uvs.y);
  s.position = point.corner[0] * point.weight[0] + point.corner[1] * point.weight[1] +
               point.corner[2] * point.weight[2];
  s.reach = largest_abs(s.position);
  for (int i = 0; i < 3; ++i) s.reach = max2(s.reach, largest_abs(point.corner[i] - s.position));
  s.view = from_viewer * -1.0f;
  vec3 across = cross3(point.corner[1] - point.corner[0], point.corner[2] - point.corner[0]);
  s.geometric = normalize_or(across, s.view);
  uvec4 n0;
  uvec4 n1;
  uvec4 n2;
  LOAD4(n0, normal_map, point.texel[0]);
  LOAD4(n1, normal_map, point.texel[1]);
  LOAD4(n2, normal_map, point.texel[2]);
  s.normal = normalize_or(
      as_vec3(n0) * point.weight[0] + as_vec3(n1) * point.weight[1] + as_vec3(n2) * point.weight[2],
      s.geometric);
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
  s.emission = material.emissive;
  if (material.emissive_texture != no_index) {
    vec4 texel = sample_texture(material.emissive_texture, uvs, true);
    s.emission = s.emission * vec3(texel.x, texel.y, texel.z);
  }
  if (material.normal_texture != no_index) {
    vec4 tangent = tangent_at(point, textures[material.normal_texture].texcoord, s.normal);
    vec3 t = vec3(tangent.x, tangent.y, tangent.z);
    t = normalize_or(t - s.normal * dot3(s.normal, t), vec3(0.0f, 0.0f, 0.0f));
    vec3 b = cross3(s.normal, t) * tangent.w;
    vec4 texel = sample_texture(material.normal_texture, uvs, false);
    vec3 bent = t * ((texel.x * 2.0f - 1.0f) * material.normal_scale) +
                b * ((texel.y * 2.0f - 1.0f) * material.normal_scale) + s.normal * (texel.z * 2.0f - 1.0f);
    s.normal = normalize_or(bent, s.normal);
  }
  // Both sides are lit alike: turn the normals to the viewer, the shading normal with the geometric one.
  s.geometric = select(dot3(s.geometric, s.view) < 0.0f, s.geometric * -1.0f, s.geometric);
  s.normal = select(dot3(s.normal, s.geometric) < 0.0f, s.normal * -1.0f, s.normal);
  return s;
}
