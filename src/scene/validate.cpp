// SPDX-License-Identifier: MIT
// The promises of scene.h, checked. Loaders report most faults closer to their cause; this is the last line.
#include <algorithm>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/scene/scene.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

bool finite(float x) {
  return std::isfinite(x);
}
bool finite(const Influence& influence) {
  return std::isfinite(influence.weight);
}

template <glm::length_t N>
bool finite(const glm::vec<N, float>& v) {
  bool all = true;
  for (glm::length_t i = 0; i < N; ++i) all = all && std::isfinite(v[i]);
  return all;
}

bool finite(const glm::quat& q) {
  return finite(glm::vec4(q.x, q.y, q.z, q.w));
}

bool finite(const glm::mat4& m) {
  return finite(m[0]) && finite(m[1]) && finite(m[2]) && finite(m[3]);
}

// Neither negative nor so bright that sums and products of it leave the range of floats.
bool is_light(const glm::vec3& color) {
  constexpr float brightest = 1e30f;
  for (glm::length_t i = 0; i < 3; ++i) {
    if (!(color[i] >= 0 && color[i] <= brightest)) return false;
  }
  return true;
}

class Validator {
 public:
  explicit Validator(const Scene& scene) : scene_(scene) {
    for (const Mesh& m : scene_.meshes) {
      last_joint_.push_back(0);
      for (const Influence& i : m.influences) last_joint_.back() = std::max(last_joint_.back(), i.joint);
    }
  }

  void run() const {
    for (size_t i = 0; i < scene_.meshes.size(); ++i)
      mesh(label("mesh", i, scene_.meshes[i].name), scene_.meshes[i]);
    for (size_t i = 0; i < scene_.skins.size(); ++i)
      skin(label("skin", i, scene_.skins[i].name), scene_.skins[i]);
    for (size_t i = 0; i < scene_.nodes.size(); ++i)
      node(label("node", i, scene_.nodes[i].name), uint32_t(i));
    for (size_t i = 0; i < scene_.animations.size(); ++i) {
      const Animation& animation = scene_.animations[i];
      for (const Channel& c : animation.channels) channel(label("animation", i, animation.name), c);
    }
    for (size_t i = 0; i < scene_.cameras.size(); ++i) {
      camera(label("camera", i, scene_.cameras[i].name), scene_.cameras[i]);
    }
    for (size_t i = 0; i < scene_.lights.size(); ++i)
      light(label("light", i, scene_.lights[i].name), scene_.lights[i]);
    for (size_t i = 0; i < scene_.materials.size(); ++i) {
      material(label("material", i, scene_.materials[i].name), scene_.materials[i]);
    }
    for (size_t i = 0; i < scene_.images.size(); ++i)
      image(label("image", i, scene_.images[i].name), scene_.images[i]);
    if (scene_.sky) {
      check(finite(scene_.sky->top) && finite(scene_.sky->horizon) && finite(scene_.sky->bottom), "sky",
            "a colour is not finite");
    }
    if (scene_.environment) environment(*scene_.environment);
  }

 private:
  static std::string label(const char* kind, size_t index, const std::string& name) {
    return name.empty() ? fmt::format("{} {}", kind, index)
                        : fmt::format("{} {} '{}'", kind, index, shown(name));
  }

  void check(bool good, const std::string& where, const char* what) const {
    if (!good) fail_input(scene_.name, "{}: {}; re-export the file", where, what);
  }

  template <class T>
  void check_finite(const std::vector<T>& values, const std::string& where, const char* what) const {
    for (const T& value : values) {
      if (!finite(value))
        fail_input(scene_.name, "{}: {} that is not finite; re-export the file", where, what);
    }
  }

  void mesh(const std::string& where, const Mesh& m) const {
    const size_t count = m.positions.size();
    const auto complete_or_empty = [count](const auto& array) {
      return array.empty() || array.size() == count;
    };
    check(m.normals.size() == count, where, "not one normal a vertex");
    check(complete_or_empty(m.tangents), where, "not one tangent a vertex");
    check(complete_or_empty(m.texcoords[0]) && complete_or_empty(m.texcoords[1]), where,
          "not one texture coordinate a vertex");
    check(complete_or_empty(m.colors), where, "not one colour a vertex");
    check_finite(m.positions, where, "a position");
    check_finite(m.normals, where, "a normal");
    check_finite(m.tangents, where, "a tangent");
    check_finite(m.texcoords[0], where, "a texture coordinate");
    check_finite(m.texcoords[1], where, "a texture coordinate");
    check_finite(m.colors, where, "a colour");
    for (const glm::uvec3& t : m.triangles) {
      check(t.x < count && t.y < count && t.z < count, where,
            "a triangle names a vertex that does not exist");
    }
    parts(where, m);
    grids(where, m);
    check(m.weights.size() == m.targets.size(), where, "not one default weight a morph target");
    check_finite(m.weights, where, "a morph weight");
    for (const MorphTarget& t : m.targets) target(where + ", morph target '" + shown(t.name) + "'", t, count);
    influences(where, m);
  }

  void parts(const std::string& where, const Mesh& m) const {
    uint64_t next = 0;
    for (const Part& part : m.parts) {
      check(part.first_triangle == next && part.triangle_count > 0, where,
            "parts that do not follow one another");
      check(part.material == none || part.material < scene_.materials.size(), where,
            "a part has a material that does not exist");
      next += part.triangle_count;
    }
    check(next == m.triangles.size(), where, "parts that do not cover its triangles");
  }

  void grids(const std::string& where, const Mesh& m) const {
    if (m.grids.empty()) return;
    uint64_t next = 0;
    for (const Grid& grid : m.grids) {
      check(grid.width >= 2 && grid.height >= 2, where, "a grid of fewer than 2 x 2 samples");
      check(grid.vertices.size() == uint64_t(grid.width) * grid.height, where,
            "a grid without a vertex a sample");
      check(grid.first_triangle == next, where, "grids that do not follow one another");
      next += uint64_t(2) * (grid.width - 1) * (grid.height - 1);
      check(next <= m.triangles.size(), where, "grids of more triangles than there are");
      grid_triangles(where, m, grid);
    }
    check(next == m.triangles.size(), where, "grids that do not cover its triangles");
  }

  void grid_triangles(const std::string& where, const Mesh& m, const Grid& grid) const {
    for (uint32_t y = 0; y + 1 < grid.height; ++y) {
      for (uint32_t x = 0; x + 1 < grid.width; ++x) {
        const size_t corner = size_t(y) * grid.width + x;
        const uint32_t a = grid.vertices[corner], b = grid.vertices[corner + 1];
        const uint32_t c = grid.vertices[corner + grid.width], d = grid.vertices[corner + grid.width + 1];
        const size_t triangle = grid.first_triangle + 2 * (size_t(y) * (grid.width - 1) + x);
        check(
            m.triangles[triangle] == glm::uvec3(a, b, c) && m.triangles[triangle + 1] == glm::uvec3(d, c, b),
            where, "a quad of a grid is not the two triangles it should be");
      }
    }
  }

  void target(const std::string& where, const MorphTarget& t, size_t vertex_count) const {
    check(t.positions.size() == t.vertices.size(), where, "not one delta a vertex");
    check(t.normals.empty() || t.normals.size() == t.vertices.size(), where, "not one normal delta a vertex");
    check(t.tangents.empty() || t.tangents.size() == t.vertices.size(), where,
          "not one tangent delta a vertex");
    for (size_t i = 0; i < t.vertices.size(); ++i) {
      check(t.vertices[i] < vertex_count, where, "a vertex that does not exist");
      check(i == 0 || t.vertices[i] > t.vertices[i - 1], where, "vertices that do not ascend");
    }
    check_finite(t.positions, where, "a delta");
    check_finite(t.normals, where, "a normal delta");
    check_finite(t.tangents, where, "a tangent delta");
  }

  void influences(const std::string& where, const Mesh& m) const {
    if (m.first_influence.empty()) {
      check(m.influences.empty(), where, "skin influences of no vertex");
      return;
    }
    check(m.first_influence.size() == m.positions.size() + 1, where,
          "not one list of skin influences a vertex");
    check(m.first_influence.front() == 0 && m.first_influence.back() == m.influences.size(), where,
          "lists of skin influences that do not cover them");
    check_finite(m.influences, where, "a skin weight");
    constexpr double tolerance = 1e-3;  // generous: 255 and 65,535 do not divide evenly
    for (size_t v = 0; v < m.positions.size(); ++v) {
      check(
          m.first_influence[v] < m.first_influence[v + 1] && m.first_influence[v + 1] <= m.influences.size(),
          where, "a vertex without skin influences");
      double sum = 0;
      for (uint32_t i = m.first_influence[v]; i < m.first_influence[v + 1]; ++i)
        sum += double(m.influences[i].weight);
      check(std::abs(sum - 1) <= tolerance, where, "skin weights that do not sum to 1");
    }
  }

  void skin(const std::string& where, const Skin& s) const {
    check(!s.joints.empty(), where, "no joints");
    check(s.inverse_binds.size() == s.joints.size(), where, "not one inverse bind matrix a joint");
    for (uint32_t joint : s.joints) check(joint < scene_.nodes.size(), where, "a joint that does not exist");
    check_finite(s.inverse_binds, where, "an inverse bind matrix");
  }

  void node(const std::string& where, uint32_t index) const {
    const Node& n = scene_.nodes[index];
    const auto exists = [](uint32_t i, const auto& array) { return i == none || i < array.size(); };
    check(n.parent == none || n.parent < index, where, "its parent does not come before it");
    check(exists(n.mesh, scene_.meshes), where, "its mesh does not exist");
    check(exists(n.skin, scene_.skins), where, "its skin does not exist");
    check(exists(n.camera, scene_.cameras), where, "its camera does not exist");
    check(exists(n.light, scene_.lights), where, "its light does not exist");
    check(finite(n.translation) && finite(n.rotation) && finite(n.scale) && (!n.matrix || finite(*n.matrix)),
          where, "a transform that is not finite");
    check_finite(n.weights, where, "a morph weight");
    const size_t targets = n.mesh == none ? 0 : scene_.meshes[n.mesh].targets.size();
    check(n.weights.empty() || n.weights.size() == targets, where, "not one weight a morph target");
    const bool skinned = n.mesh != none && !scene_.meshes[n.mesh].first_influence.empty();
    check(skinned == (n.skin != none), where,
          "a skin without a mesh that has influences, or the other way round");
    if (!skinned) return;
    check(last_joint_[n.mesh] < scene_.skins[n.skin].joints.size(), where,
          "its mesh follows a joint that its skin does not have");
  }

  void channel(const std::string& where, const Channel& c) const {
    check(c.node < scene_.nodes.size(), where, "a channel moves a node that does not exist");
    const Node& n = scene_.nodes[c.node];
    check(!c.times.empty(), where, "a channel without keys");
    for (size_t i = 0; i < c.times.size(); ++i) {
      check(finite(c.times[i]), where, "a key at a time that is not finite");
      check(i == 0 || c.times[i] > c.times[i - 1], where, "keys whose times do not ascend");
    }
    size_t width = c.path == Channel::Path::rotation ? 4 : 3;
    if (c.path == Channel::Path::weights) {
      width = n.mesh == none ? 0 : scene_.meshes[n.mesh].targets.size();
      check(width > 0, where, "a channel moves the morph weights of a node without morph targets");
    } else {
      check(!n.matrix, where, "a channel moves a node that has a matrix");
    }
    if (c.interpolation == Channel::Interpolation::cubic_spline) width *= 3;
    check(c.values.size() == c.times.size() * width, where, "a channel with too few or too many values");
    check_finite(c.values, where, "a key's value");
  }

  void camera(const std::string& where, const Camera& c) const {
    check(finite(c.yfov) && finite(c.aspect) && finite(c.xmag) && finite(c.ymag) && finite(c.znear) &&
              finite(c.zfar),
          where, "a number that is not finite");
    check(!c.perspective || (c.yfov > 0 && c.yfov < 3.14159274f), where,
          "a field of view outside 0 to 180 degrees");
    check(c.perspective || (c.xmag != 0 && c.ymag != 0), where, "an extent of zero");
    check(c.aspect >= 0 && c.znear >= 0 && c.zfar >= 0, where,
          "a negative aspect ratio or clipping distance");
  }

  void light(const std::string& where, const Light& l) const {
    check(finite(l.color) && finite(l.intensity) && finite(l.range) && finite(l.inner_cone) &&
              finite(l.outer_cone),
          where, "a number that is not finite");
    check(l.intensity >= 0 && l.range >= 0, where, "a negative intensity or range");
    check(is_light(l.color * l.intensity), where, "a colour that is negative or brighter than 1e30");
  }

  void material(const std::string& where, const Material& m) const {
    check(finite(m.base_color) && finite(m.metallic) && finite(m.roughness) && finite(m.emissive) &&
              finite(m.normal_scale) && finite(m.occlusion_strength) && finite(m.alpha_cutoff),
          where, "a number that is not finite");
    check(is_light(m.emissive), where, "a glow that is negative or brighter than 1e30");
    layers(where, m);
    for (const Texture* t : m.textures()) {
      check(t->image == none || t->image < scene_.images.size(), where,
            "a texture of an image that does not exist");
      check(t->texcoord < 2, where, "a texture of a set of texture coordinates other than 0 and 1");
      check(finite(t->u_row) && finite(t->v_row), where, "a texture transform that is not finite");
    }
  }

  void layers(const std::string& where, const Material& m) const {
    const auto is_share = [](float x) { return x >= 0 && x <= 1; };
    check(finite(m.ior) && (m.ior == 0 || m.ior >= 1), where, "an index of refraction below 1");
    check(is_share(m.specular) && is_share(m.transmission) && is_share(m.clearcoat) &&
              is_share(m.clearcoat_roughness),
          where, "specular, transmission, clearcoat or its roughness outside 0 to 1");
    check(is_light(m.specular_color), where, "a specular colour that is negative or brighter than 1e30");
    check(finite(m.thickness) && m.thickness >= 0 && finite(m.attenuation_distance) &&
              m.attenuation_distance >= 0,
          where, "a thickness or attenuation distance that is negative or not finite");
    for (glm::length_t i = 0; i < 3; ++i)
      check(is_share(m.attenuation_color[i]), where, "an attenuation colour outside 0 to 1");
    check(finite(m.clearcoat_normal_scale), where, "a number that is not finite");
  }

  void environment(const Environment& e) const {
    const std::string where = "environment";
    check(
        e.width > 0 && e.height > 0 && e.width <= max_environment_width && e.height <= max_environment_height,
        where, "no texels, or too many");
    check(e.radiance.size() == uint64_t(e.width) * e.height, where, "not one radiance a texel");
    check(finite(e.rotation), where, "a rotation that is not finite");
    for (const glm::vec3& radiance : e.radiance) {
      check(is_light(radiance) && is_light(radiance * e.strength), where,
            "radiance that is negative or brighter than 1e30");
    }
  }

  void image(const std::string& where, const Image& i) const {
    check(i.width > 0 && i.height > 0, where, "no texels");
    check(i.rgba.size() == uint64_t(i.width) * i.height * 4, where, "not four bytes a texel");
  }

  const Scene& scene_;
  std::vector<uint32_t> last_joint_;  // the highest that each mesh follows
};

}  // namespace

void validate(const Scene& scene) {
  Validator(scene).run();
}

}  // namespace lodestone::scene
