// SPDX-License-Identifier: MIT
// PLY: elements in any order, each with properties of any type in any order. Of the element `vertex` the
// position, normal, colour and texture coordinates are read, of `face` the polygon; everything else is passed
// over.
//
// Integer colours are taken as sRGB-encoded, as scanning tools write them, floating-point ones as linear.
// Texture coordinates count from the bottom of the image and are turned over.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/load.h"
#include "lodestone/scene/mesh_tools.h"
#include "lodestone/scene/ply_header.h"
#include "lodestone/scene/ply_source.h"
#include "lodestone/scene/single_mesh.h"

namespace lodestone::scene {
namespace ply {
namespace {

// What a vertex's properties mean.
enum Slot : uint32_t { x, y, z, nx, ny, nz, red, green, blue, alpha, u, v, slot_count };

struct SlotName {
  std::string_view property;
  Slot slot;
};

constexpr std::array slot_names{
    SlotName{"x", x},
    SlotName{"y", y},
    SlotName{"z", z},
    SlotName{"nx", nx},
    SlotName{"ny", ny},
    SlotName{"nz", nz},
    SlotName{"red", red},
    SlotName{"green", green},
    SlotName{"blue", blue},
    SlotName{"alpha", alpha},
    SlotName{"r", red},
    SlotName{"g", green},
    SlotName{"b", blue},
    SlotName{"a", alpha},
    SlotName{"diffuse_red", red},
    SlotName{"diffuse_green", green},
    SlotName{"diffuse_blue", blue},
    SlotName{"s", u},
    SlotName{"t", v},
    SlotName{"u", u},
    SlotName{"v", v},
    SlotName{"texture_u", u},
    SlotName{"texture_v", v},
    SlotName{"texture_s", u},
    SlotName{"texture_t", v},
};

// How to read the records of element `vertex`.
class VertexPlan {
 public:
  VertexPlan(const std::string& file, const Element& element) {
    for (const Property& property : element.properties) {
      slots_.push_back(property.is_list ? std::optional<Slot>() : slot_of(property.name));
      if (slots_.back()) {
        has_[*slots_.back()] = true;
        types_[*slots_.back()] = property.type;
      }
    }
    if (!has_[x] || !has_[y] || !has_[z]) {
      fail_input(file, "element vertex has no properties x, y and z; export the file with positions");
    }
  }

  // The slot of property i; nothing where it is passed over.
  std::optional<Slot> slot(size_t i) const { return slots_[i]; }
  bool has_normal() const { return has_[nx] && has_[ny] && has_[nz]; }
  bool has_color() const { return has_[red] && has_[green] && has_[blue]; }
  bool has_texcoord() const { return has_[u] && has_[v]; }

  glm::vec4 color(const std::array<double, slot_count>& values) const {
    glm::vec4 result(1);
    for (int c = 0; c < 3; ++c) {
      const Type type = types_[red + c];
      const double scaled = values[red + c] / full_scale(type);
      const bool encoded = type != Type::float32 && type != Type::float64;
      result[c] = encoded ? decode_srgb(static_cast<float>(scaled)) : static_cast<float>(scaled);
    }
    if (has_[alpha]) result.a = static_cast<float>(values[alpha] / full_scale(types_[alpha]));
    return result;
  }

 private:
  static std::optional<Slot> slot_of(std::string_view property) {
    for (const SlotName& candidate : slot_names) {
      if (candidate.property == property) return candidate.slot;
    }
    return std::nullopt;
  }

  std::vector<std::optional<Slot>> slots_;
  std::array<bool, slot_count> has_{};
  std::array<Type, slot_count> types_{};
};

template <class Source>
class BodyReader {
 public:
  BodyReader(const std::string& file, std::string_view bytes, const Header& header, Mesh& mesh)
      : file_(file), header_(header), source_(file, bytes, header), mesh_(mesh) {}

  void read() {
    for (const Element& element : header_.elements) {
      if (element.properties.empty()) continue;  // nothing is stored, whatever the count
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        for (uint64_t i = 0; i < element.count; ++i) {
          for (const Property& property : element.properties) skip(property);
        }
      }
    }
    if (small_faces_ > 0) {
      log::warn(fmt::format("{}: {} faces of fewer than 3 corners are left out", file_, small_faces_));
    }
  }

 private:
  void read_vertices(const Element& element) {
    const VertexPlan plan(file_, element);
    mesh_.positions.reserve(element.count);
    if (plan.has_normal()) mesh_.normals.reserve(element.count);
    if (plan.has_color()) mesh_.colors.reserve(element.count);
    if (plan.has_texcoord()) mesh_.texcoords[0].reserve(element.count);
    std::array<double, slot_count> values{};
    for (uint64_t i = 0; i < element.count; ++i) {
      for (size_t p = 0; p < element.properties.size(); ++p) {
        const std::optional<Slot> slot = plan.slot(p);
        if (slot) {
          values[*slot] = finite_value(element.properties[p], i);
        } else {
          skip(element.properties[p]);
        }
      }
      add_vertex(plan, values);
    }
  }

  // A value that fits a float.
  double finite_value(const Property& property, uint64_t record) {
    const double value = source_.value(property.type);
    if (!std::isfinite(static_cast<float>(value))) {
      fail_input(file_,
                 "{}: {} of vertex {} is not a finite number; remove the vertex or export the file again",
                 source_.place(), property.name, record);
    }
    return value;
  }

  void add_vertex(const VertexPlan& plan, const std::array<double, slot_count>& values) {
    mesh_.positions.emplace_back(values[x], values[y], values[z]);
    if (plan.has_normal()) mesh_.normals.emplace_back(values[nx], values[ny], values[nz]);
    if (plan.has_color()) mesh_.colors.push_back(plan.color(values));
    if (plan.has_texcoord()) mesh_.texcoords[0].emplace_back(values[u], 1 - values[v]);
  }

  void read_faces(const Element& element) {
    uint32_t polygon = element.find("vertex_indices");
    if (polygon == none) polygon = element.find("vertex_index");
    if (polygon == none || !element.properties[polygon].is_list) {
      fail_input(file_, "element face has no list vertex_indices; export the file as a polygon mesh");
    }
    for (uint64_t i = 0; i < element.count; ++i) {
      for (size_t p = 0; p < element.properties.size(); ++p) {
        if (p == polygon) {
          read_polygon(element.properties[p], i);
        } else {
          skip(element.properties[p]);
        }
      }
    }
  }

  void read_polygon(const Property& property, uint64_t face) {
    const uint64_t corners = list_count(property);
    if (corners < 3) {
      source_.skip(corners, property.type);
      ++small_faces_;
      return;
    }
    const uint32_t first = read_index(property.type, face);
    uint32_t previous = read_index(property.type, face);
    for (uint64_t corner = 2; corner < corners; ++corner) {
      const uint32_t current = read_index(property.type, face);
      if (mesh_.triangles.size() == none - 1) fail_too_many(file_);
      mesh_.triangles.emplace_back(first, previous, current);
      previous = current;
    }
  }

  uint32_t read_index(Type type, uint64_t face) {
    const double index = source_.value(type);
    const uint64_t vertices = header_.find("vertex")->count;
    if (!(index >= 0 && index < static_cast<double>(vertices) && index == std::floor(index))) {
      fail_input(file_,
                 "{}: face {} names vertex {}, but there are the vertices 0 to {}; export the file again",
                 source_.place(), face, index, vertices - 1);
    }
    return static_cast<uint32_t>(index);
  }

  uint64_t list_count(const Property& property) {
    const double count = source_.value(property.count_type);
    if (!(count >= 0 && count <= 4294967295.0 && count == std::floor(count))) {
      fail_input(file_, "{}: list {} has {} items; export the file again", source_.place(),
                 printable(property.name), count);
    }
    return static_cast<uint64_t>(count);
  }

  void skip(const Property& property) {
    const uint64_t values = property.is_list ? list_count(property) : 1;
    source_.skip(values, property.type);
  }

  const std::string& file_;
  const Header& header_;
  Source source_;
  Mesh& mesh_;
  uint64_t small_faces_ = 0;
};

void check_elements(const std::string& file, const Header& header) {
  const Element* vertices = header.find("vertex");
  const Element* faces = header.find("face");
  if (vertices == nullptr || vertices->count == 0) {
    fail_input(file, "has no vertices; export the file as a polygon mesh");
  }
  if (vertices->properties.empty()) fail_input(file, "element vertex has no properties x, y and z");
  if (vertices->count >= none) fail_too_many(file);
  if (faces == nullptr || faces->count == 0) {
    fail_input(file,
               "has vertices but no faces; point clouds and triangle strips are not read, export triangles");
  }
  if (faces->properties.empty()) fail_input(file, "element face has no list vertex_indices");
}

template <class Source>
void read_body(const std::string& file, std::string_view bytes, const Header& header, Mesh& mesh) {
  BodyReader<Source>(file, bytes, header, mesh).read();
}

}  // namespace
}  // namespace ply

Scene load_ply(const std::filesystem::path& path) {
  const std::string file = path.string();
  Mesh mesh;
  {
    const std::vector<std::byte> contents = read_file(path);
    const std::string_view bytes = as_text(contents);
    const ply::Header header = ply::parse_header(file, bytes);
    ply::check_elements(file, header);
    switch (header.format) {
      case ply::Format::ascii:
        ply::read_body<ply::AsciiSource>(file, bytes, header, mesh);
        break;
      case ply::Format::binary_little_endian:
        ply::read_body<ply::BinarySource<std::endian::little>>(file, bytes, header, mesh);
        break;
      case ply::Format::binary_big_endian:
        ply::read_body<ply::BinarySource<std::endian::big>>(file, bytes, header, mesh);
        break;
    }
  }
  if (mesh.triangles.empty())
    fail_input(file, "has no face of 3 or more corners; export the file as a polygon mesh");
  complete_normals(mesh);
  return single_mesh_scene(path, std::move(mesh));
}

}  // namespace lodestone::scene
