// SPDX-License-Identifier: MIT
// Wavefront OBJ: polygons of positions, texture coordinates and normals that are indexed apart. A file
// becomes one mesh in the order of its faces; `o` and `g` only group. Curves, surfaces, lines and points are
// passed over.
//
// The reader is ours because a message has to name the line at fault, and because malformed numbers have to
// be errors; tinyobjloader gives no lines and reads what it cannot parse as zero.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/first_use.h"
#include "lodestone/scene/load.h"
#include "lodestone/scene/mesh_tools.h"
#include "lodestone/scene/obj_materials.h"
#include "lodestone/scene/single_mesh.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

// Position, texture coordinates and normal of a corner, counted from 0; `none` for what is absent.
using Corner = FirstUse<3>::Key;

class ObjParser {
 public:
  ObjParser(const std::string& file, std::string_view text, ObjMaterials& materials, Mesh& mesh)
      : reader_(file, text, 1, true), materials_(materials), mesh_(mesh) {}

  void parse() {
    do {
      parse_line();
    } while (reader_.next_line());
    if (small_faces_ > 0) {
      log::warn(fmt::format("{}: faces of fewer than 3 corners are left out: {}, the first in line {}",
                            reader_.file(), small_faces_, first_small_line_));
    }
    if (mesh_.triangles.empty()) {
      if (positions_.empty()) fail_input(reader_.file(), "holds no vertex (v): is it an OBJ file at all?");
      fail_input(reader_.file(),
                 "has no faces; export it as a polygon mesh, or get it whole if it was cut off");
    }
    build_vertices();
  }

 private:
  void parse_line() {
    const std::string_view keyword = reader_.word();
    if (keyword == "v") {
      positions_.push_back(parse_vector("a coordinate of v"));
      parse_color();
      check_count(positions_.size());
    } else if (keyword == "vt") {
      texcoords_.push_back(parse_texcoord());
      check_count(texcoords_.size());
    } else if (keyword == "vn") {
      normals_.push_back(parse_vector("a coordinate of vn"));
      check_count(normals_.size());
    } else if (keyword == "f" || keyword == "fo") {
      parse_face();
    } else if (keyword == "usemtl") {
      material_ = materials_.find(reader_.rest_of_line());
    } else if (keyword == "mtllib") {
      parse_libraries();
    } else if (is_geometry(keyword)) {
      log::warn_once("obj " + std::string(keyword) + reader_.file(),
                     fmt::format("{}: line {}: `{}` is left out; only faces are read", reader_.file(),
                                 reader_.line(), keyword));
    }
  }

  static bool is_geometry(std::string_view keyword) {
    return keyword == "l" || keyword == "p" || keyword == "curv" || keyword == "curv2" || keyword == "surf";
  }

  void check_count(size_t count) const {
    if (count >= none) fail_too_many(reader_.file());
  }

  glm::vec3 parse_vector(const char* what) {
    const float x = reader_.read_float(what), y = reader_.read_float(what), z = reader_.read_float(what);
    return {x, y, z};
  }

  // `x y z r g b`, as scanning and sculpting tools write it: encoded as sRGB, 0 to 1. `x y z w` has a weight,
  // which only curves use.
  void parse_color() {
    const std::string_view first = reader_.word(), second = reader_.word();
    if (second.empty() || first.front() == '#' || second.front() == '#') return;
    const char* what = "a colour of v";
    glm::vec3 color;
    color.r = decode_srgb(reader_.to_float(first, what));
    color.g = decode_srgb(reader_.to_float(second, what));
    color.b = decode_srgb(reader_.read_float(what));
    colors_.resize(positions_.size(), glm::vec4(1));
    colors_.back() = glm::vec4(color, 1);
  }

  // `u [v [w]]`; v counts from the bottom of the image and is turned over.
  glm::vec2 parse_texcoord() {
    const float u = reader_.read_float("a coordinate of vt");
    const std::string_view second = reader_.word();
    const float v = second.empty() ? 0 : reader_.to_float(second, "a coordinate of vt");
    return {u, 1 - v};
  }

  // The statement lists several names, or one with blanks in it. The whole of it is tried where it is one
  // file.
  void parse_libraries() {
    const std::string_view names = reader_.rest_of_line();
    const size_t extension = names.rfind(".mtl");
    const bool several = extension != std::string_view::npos && names.find(".mtl ") < extension;
    if (!several) return materials_.read_library(std::string(names));
    TextReader words(reader_.file(), names, reader_.line());
    for (std::string_view name = words.word(); !name.empty(); name = words.word()) {
      materials_.read_library(std::string(name));
    }
  }

  void parse_face() {
    uint32_t first = none, previous = none;
    size_t corners = 0;
    for (std::string_view word = reader_.word(); !word.empty(); word = reader_.word(), ++corners) {
      if (word.front() == '#') break;
      const uint32_t current = parse_corner(word);
      if (corners == 0) first = current;
      if (corners >= 2) add_triangle({first, previous, current});
      previous = current;
    }
    if (corners >= 3) return;
    if (reader_.at_end()) reader_.fail("the file ends in the middle of a face: it was cut off; get it whole");
    ++small_faces_;
    if (first_small_line_ == 0) first_small_line_ = reader_.line();
  }

  void add_triangle(const glm::uvec3& triangle) {
    check_count(mesh_.triangles.size() + 1);
    const auto index = static_cast<uint32_t>(mesh_.triangles.size());
    if (mesh_.parts.empty() || mesh_.parts.back().material != material_) {
      mesh_.parts.push_back({index, 0, material_});
    }
    ++mesh_.parts.back().triangle_count;
    mesh_.triangles.push_back(triangle);
  }

  // `v`, `v/vt`, `v//vn` or `v/vt/vn`; the vertex that stands for the three.
  uint32_t parse_corner(std::string_view word) {
    const std::array<size_t, 3> counts{positions_.size(), texcoords_.size(), normals_.size()};
    Corner corner{none, none, none};
    std::string_view rest = word;
    for (size_t i = 0; i < 3; ++i) {
      const size_t slash = rest.find('/');
      const std::string_view field = rest.substr(0, slash);
      if (!field.empty()) corner[i] = parse_index(field, counts[i]);
      if (slash == std::string_view::npos) break;
      if (i == 2)
        reader_.fail("the corner `{}` has more than three indices; export the file again", printable(word));
      rest.remove_prefix(slash + 1);
    }
    if (corner[0] == none)
      reader_.fail("the corner `{}` names no vertex; export the file again", printable(word));
    const uint32_t vertex = corners_.number(corner);
    if (vertex == corner_lines_.size()) {
      check_count(corner_lines_.size() + 1);
      corner_lines_.push_back(reader_.line());
    }
    return vertex;
  }

  // Indices count from 1, negative ones back from the last one so far. A positive one may look ahead; whether
  // what it names is there is known at the end of the file only.
  uint32_t parse_index(std::string_view field, size_t count) const {
    const int64_t index = reader_.to_integer(field, "an index");
    const auto known = static_cast<int64_t>(count);
    if (index == 0) reader_.fail("index 0 in a face; indices count from 1, export the file again");
    if (index < -known) {
      reader_.fail("index {} in a face counts back behind the first of {}; export the file again", index,
                   known);
    }
    if (index >= int64_t(none))
      reader_.fail("index {} in a face is out of range; export the file again", index);
    return static_cast<uint32_t>(index > 0 ? index - 1 : known + index);
  }

  void check_corners() const {
    static constexpr std::array<const char*, 3> keywords{"v", "vt", "vn"};
    const std::array<size_t, 3> counts{positions_.size(), texcoords_.size(), normals_.size()};
    for (size_t vertex = 0; vertex < corners_.keys().size(); ++vertex) {
      for (size_t i = 0; i < 3; ++i) {
        const uint32_t index = corners_.keys()[vertex][i];
        if (index != none && index >= counts[i]) {
          fail_input(reader_.file(),
                     "line {}: a face names {} {}, but the file has {}; export the file again",
                     corner_lines_[vertex], keywords[i], uint64_t(index) + 1, counts[i]);
        }
      }
    }
  }

  void build_vertices() {
    check_corners();
    const std::vector<Corner>& corners = corners_.keys();
    bool has_texcoords = false, has_normals = false;
    mesh_.positions.reserve(corners.size());
    for (const auto& [position, texcoord, normal] : corners) {
      mesh_.positions.push_back(positions_[position]);
      has_texcoords |= texcoord != none;
      has_normals |= normal != none;
    }
    if (!colors_.empty()) {
      colors_.resize(positions_.size(), glm::vec4(1));
      mesh_.colors.reserve(corners.size());
      for (const Corner& corner : corners) mesh_.colors.push_back(colors_[corner[0]]);
    }
    if (has_texcoords) {
      mesh_.texcoords[0].reserve(corners.size());
      for (const Corner& corner : corners) {
        mesh_.texcoords[0].push_back(corner[1] == none ? glm::vec2(0) : texcoords_[corner[1]]);
      }
    }
    if (has_normals) {
      // A zero normal is replaced by a smooth one later.
      mesh_.normals.reserve(corners.size());
      for (const Corner& corner : corners) {
        mesh_.normals.push_back(corner[2] == none ? glm::vec3(0) : normals_[corner[2]]);
      }
    }
  }

  TextReader reader_;
  ObjMaterials& materials_;
  Mesh& mesh_;
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec2> texcoords_;
  std::vector<glm::vec4> colors_;       // linear; empty, or as many as positions up to the last that has one
  FirstUse<3> corners_;                 // the mesh's vertices
  std::vector<uint64_t> corner_lines_;  // where each is first used
  uint32_t material_ = none;
  uint64_t small_faces_ = 0, first_small_line_ = 0;
};

}  // namespace

Scene load_obj(const std::filesystem::path& path) {
  const std::string file = path.string();
  ObjMaterials materials(path);
  Mesh mesh;
  {
    const std::vector<std::byte> contents = read_file(path);
    ObjParser(file, as_text(contents), materials, mesh).parse();
  }
  complete_normals(mesh);
  Scene scene = single_mesh_scene(path, std::move(mesh));
  materials.move_to(scene);
  return scene;
}

}  // namespace lodestone::scene
