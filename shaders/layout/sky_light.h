// SPDX-License-Identifier: MIT
// What comes from the whole sky by way of a surface, with one shadow ray: all of the diffuse part, and the
// mirror part as far as the shadow rays of the diffuse one get through. Included behind layout/environment.h.

FN vec3 mirrored_sky(vec3 normal, vec3 view) {
  vec3 mirror = normal * (2.0f * dot3(normal, view)) - view;
  return environment_radiance(normalize_or(mirror, normal));
}

FN LightSample sample_sky(IN(Surface) s, vec2 xi, IN(Traced) traced) {
  LightSample result;
  result.distance = 1e30f;
  vec1 weight = 1.0f;
  if (environment_map == 0u) {
    result.direction = cosine_direction(s.normal, xi);
  } else {
    // A map may have a sun that is a millionth of the sky: one direction of two is by its light, and both
    // kinds count as of the mean density of the two (Veach and Guibas 1995, the balance heuristic).
    bvec1 by_light = xi.x < 0.5f;
    vec2 half_xi = vec2(2.0f * select(by_light, xi.x, xi.x - 0.5f), xi.y);
    EnvironmentSample light = sample_environment(half_xi);
    vec3 around = cosine_direction(s.normal, half_xi);
    result.direction = select(by_light, light.direction, around);
    vec1 cosine_pdf = max2(dot3(s.normal, result.direction), 0.0f) * (1.0f / pi);
    vec1 light_pdf = select(by_light, light.pdf, environment_pdf(around));
    vec1 sum = cosine_pdf + light_pdf;
    weight = select(sum > 0.0f, 2.0f * cosine_pdf / sum, 0.0f);
  }
  vec3 f = sky_specular(s);
  vec3 sent = diffuse_color(s) * environment_radiance(result.direction) * (vec3(1.0f, 1.0f, 1.0f) - f) +
              f * (mirrored_sky(s.normal, s.view) * (1.0f - traced.base_sky));
  if (any_lane(s.clearcoat > 0.0f)) {
    sent = coated(s, sent, mirrored_sky(s.clearcoat_normal, s.view) * (1.0f - traced.coat_sky));
  }
  result.radiance = sent * s.occlusion;
  if (environment_map != 0u) result.radiance = result.radiance * weight;
  return result;
}
