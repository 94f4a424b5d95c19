// SPDX-License-Identifier: MIT
// What a file describes: meshes with morph targets and skins, a node hierarchy, animations, cameras, lights
// and materials. Plain data; units are those of the file, angles radians, colours linear Rec. 709 unless
// said. A Scene that a loader returns is valid: `validate` has passed.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lodestone::scene {

inline constexpr uint32_t none = 0xffffffffu;

// One blendshape, sparse: deltas of the listed vertices, ascending, each listed once. `normals` and
// `tangents` are empty or as long as `vertices`. Deltas add to the base before skinning (glTF 2.0, 3.7.2.2).
struct MorphTarget {
  std::string name;
  std::vector<uint32_t> vertices;
  std::vector<glm::vec3> positions, normals, tangents;
};

// Weight `weight` of joint `joint` (an index into Skin::joints).
struct Influence {
  uint32_t joint = 0;
  float weight = 0;
};

// A run of triangles of one material.
struct Part {
  uint32_t first_triangle = 0, triangle_count = 0;
  uint32_t material = none;
};

// A rectangle of width x height samples (each at least 2), row by row, that a mesh is made of. Its quad (x,
// y) has corners a = (x, y), b = (x+1, y), c = (x, y+1), d = (x+1, y+1) and is the mesh's triangles
// first_triangle + 2 * (y * (width - 1) + x) = (a, b, c) and the next one = (d, c, b).
struct Grid {
  uint32_t width = 0, height = 0;
  uint32_t first_triangle = 0;
  std::vector<uint32_t> vertices;
};

struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;       // as many as positions, unit length (loaders compute missing ones)
  std::vector<glm::vec4> tangents;      // empty, or as many; w = +1 or -1 the sign of the bitangent
  std::vector<glm::vec2> texcoords[2];  // each empty, or as many
  std::vector<glm::vec4> colors;        // empty, or as many
  std::vector<glm::uvec3> triangles;    // in the order of the file (polygons fan-split)
  std::vector<Part> parts;              // in order, covering all triangles
  std::vector<MorphTarget> targets;
  std::vector<float> weights;  // default weights, one a target
  // Skin influences, by vertex: those of vertex v are influences[first_influence[v] .. first_influence[v+1]).
  // Both empty on a mesh without a skin. Weights are normalised to sum 1, zero ones dropped.
  std::vector<uint32_t> first_influence;
  std::vector<Influence> influences;
  // Not empty where the whole mesh is made of grids: all its triangles in grid order. Borders shared by two
  // grids list equal vertices (or vertices equal in position, deltas and influences, where attributes
  // differ).
  std::vector<Grid> grids;
};

struct Skin {
  std::string name;
  std::vector<uint32_t> joints;          // nodes
  std::vector<glm::mat4> inverse_binds;  // one a joint
};

struct Camera {
  std::string name;
  bool perspective = true;
  float yfov = 0.7f;              // radians, perspective only
  float aspect = 0;               // 0: that of the image
  float xmag = 1, ymag = 1;       // half extents, orthographic only
  float znear = 0.01f, zfar = 0;  // 0: infinite
};                                // looks along -Z of its node, +Y up

struct Light {
  enum class Kind : uint32_t { directional, point, spot };  // KHR_lights_punctual
  std::string name;
  Kind kind = Kind::point;
  glm::vec3 color{1};
  float intensity = 1;  // candela (point, spot), lux (directional)
  float range = 0;      // 0: infinite
  float inner_cone = 0, outer_cone = 0.7853982f;
};  // shines along -Z of its node

struct Node {
  std::string name;
  uint32_t parent = none;  // parents come before their children
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1};
  std::optional<glm::mat4> matrix;  // instead of the three above; such a node is never animated by them
  uint32_t mesh = none, skin = none, camera = none, light = none;
  std::vector<float> weights;  // overrides Mesh::weights where not empty
};

struct Channel {
  enum class Path : uint32_t { translation, rotation, scale, weights };
  enum class Interpolation : uint32_t { linear, step, cubic_spline };
  uint32_t node = none;
  Path path = Path::translation;
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> times;  // seconds, strictly ascending
  // Values of 3, 4 (quaternion x y z w) or target-count floats a key; cubic_spline: in-tangent, value,
  // out-tangent.
  std::vector<float> values;
};

struct Animation {
  std::string name;
  std::vector<Channel> channels;
  float duration() const;  // the last key of all channels, seconds
};

struct Image {
  std::string name;
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;  // 4 bytes a texel, as stored in the file (colours sRGB-encoded), top row first
};

struct Texture {
  enum class Wrap : uint32_t { repeat, clamp, mirror };
  uint32_t image = none;
  uint32_t texcoord = 0;  // set 0 or 1
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;
  // KHR_texture_transform: uv' = rows * (u, v, 1)
  glm::vec3 u_row{1, 0, 0}, v_row{0, 1, 0};
};

struct Material {
  std::string name;
  glm::vec4 base_color{1};
  float metallic = 1, roughness = 1;
  glm::vec3 emissive{0};  // emissive strength multiplied in
  float normal_scale = 1, occlusion_strength = 1;
  float alpha_cutoff = 0.5f;
  bool alpha_mask = false;
  bool double_sided = false;
  Texture base_color_texture, metallic_roughness_texture, normal_texture, occlusion_texture, emissive_texture;
  float ior = 1.5f;             // index of refraction, at least 1; 0: infinite, all light is reflected
  float specular = 1;           // scales what the dielectric part reflects as a mirror does; texture: A
  glm::vec3 specular_color{1};  // tints that seen straight on; texture: RGB, sRGB-encoded
  Texture specular_texture, specular_color_texture;
  float transmission = 0;        // share of the light that enters that passes through, tinted by base_color
  Texture transmission_texture;  // R
  float thickness = 0;  // 0: a wall too thin to bend light; more: the surface of a solid that refracts
  // White light is of this colour behind so much of the solid, in scene units; distance 0: infinite, it stays
  // white.
  glm::vec3 attenuation_color{1};
  float attenuation_distance = 0;
  float clearcoat = 0, clearcoat_roughness = 0;  // a layer of its own on top, with an ior of 1.5
  float clearcoat_normal_scale = 1;
  Texture clearcoat_texture, clearcoat_roughness_texture,
      clearcoat_normal_texture;  // R; G; as normal_texture

  std::array<const Texture*, 11> textures() const;  // with an image or without
};

// The light from all directions that no surface blocks: bottom at -Y, horizon, top at +Y, blended by height;
// W/sr/m2.
struct Sky {
  glm::vec3 top{0}, horizon{0}, bottom{0};
};

// The largest environment map: texels, which fill 2 GiB of a device.
inline constexpr uint32_t max_environment_width = 16384, max_environment_height = 8192;

// The same from a picture: equirectangular, the upper row around +Y, columns from -X by -Z, +X and +Z back to
// -X, so that its centre is where +X is; row by row from the top, finite, not negative; W/sr/m2.
struct Environment {
  std::string file;
  uint32_t width = 0, height = 0;
  std::vector<glm::vec3> radiance;
  float strength = 1;  // times this
  float rotation = 0;  // degrees about +Y: by 90, what was at +X is at -Z
};

struct Scene {
  std::string name;  // file name or builtin:NAME
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Material> materials;
  std::vector<Image> images;
  std::optional<Sky> sky;                  // where a file says nothing the renderer lights the scene itself
  std::optional<Environment> environment;  // instead of the sky
};

// Throws Error(bad_input), naming scene.name, unless every index is in range, every array as long as it must
// be, every number finite, every parent before its child, every weight count right.
void validate(const Scene& scene);

}  // namespace lodestone::scene
