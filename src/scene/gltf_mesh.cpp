// SPDX-License-Identifier: MIT
// Meshes and their primitives (3.7).
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/flat_normals.h"
#include "lodestone/scene/gltf_convert.h"
#include "lodestone/scene/mesh_tools.h"

namespace lodestone::scene {
namespace {

// All that makes the vertices of a primitive; primitives equal in it share them.
using VertexSource = std::tuple<std::map<std::string, int>, std::vector<std::map<std::string, int>>>;

struct VertexRange {
  uint32_t first = 0;
  size_t count = 0;
};

bool is_triangles(int mode) {
  return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
         mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

// The corners of the triangles of a primitive, in the order of 3.7.2.1: a strip turns every second triangle,
// so that all face the same way.
std::vector<glm::uvec3> assemble_triangles(int mode, const std::vector<uint32_t>& corners) {
  std::vector<glm::uvec3> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
      triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
    }
    return triangles;
  }
  for (size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
      triangles.emplace_back(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
    } else {
      triangles.emplace_back(corners[i + 1], corners[i + 2], corners[0]);
    }
  }
  return triangles;
}

glm::vec3 any_perpendicular(const glm::vec3& n) {
  const glm::vec3 axis = std::abs(n.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 side = glm::cross(n, axis);
  const float length = glm::length(side);
  return length > 0 ? side / length : axis;
}

class MeshConverter {
 public:
  MeshConverter(const AccessorReader& reader, size_t index)
      : reader_(reader),
        source_(reader.model().meshes[index]),
        label_(gltf_label("mesh", index, source_.name)) {}

  Mesh convert() {
    mesh_.name = source_.name;
    find_primitives();
    name_targets();
    for (size_t i : primitives_) add_primitive(i);
    // Without normals a primitive has facets, and its tangents do not count (3.7.2.1).
    if (std::any_of(flat_.begin(), flat_.end(), [](uint8_t flat) { return flat != 0; })) {
      make_flat(mesh_, flat_, [&](uint64_t bytes) { reader_.charge(bytes, 1, label_); });
      if (mesh_.positions.size() >= none) fail_too_many();
    }
    complete_normals(mesh_);
    complete_tangents();
    return std::move(mesh_);
  }

 private:
  std::string where(size_t primitive) const { return fmt::format("{}, primitive {}", label_, primitive); }

  // Keeps the primitives that are triangles, and notes which attributes any of them has.
  void find_primitives() {
    for (size_t i = 0; i < source_.primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = source_.primitives[i];
      if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
        fail_input(reader_.file(), "{}: mode {} does not exist; export it again", where(i), primitive.mode);
      }
      if (!is_triangles(primitive.mode) || !primitive.attributes.contains("POSITION")) {
        log::warn_once(reader_.file() + " no triangles",
                       fmt::format("{}: {}: points, lines and primitives without POSITION are not drawn",
                                   reader_.file(), where(i)));
        continue;
      }
      if (!primitives_.empty() &&
          primitive.targets.size() != source_.primitives[primitives_[0]].targets.size()) {
        fail_input(reader_.file(), "{}: has {} morph targets, the primitives before it {}; export it again",
                   where(i), primitive.targets.size(), source_.primitives[primitives_[0]].targets.size());
      }
      primitives_.push_back(i);
    }
  }

  [[noreturn]] void fail_too_many() const {
    fail_input(reader_.file(), "{}: more than {} vertices; split the mesh", label_, none - 1);
  }

  bool has(size_t primitive, const char* attribute) const {
    return source_.primitives[primitive].attributes.contains(attribute);
  }

  bool any_has(const char* attribute) const {
    return std::any_of(primitives_.begin(), primitives_.end(), [&](size_t i) { return has(i, attribute); });
  }

  void name_targets() {
    if (primitives_.empty()) return;
    const size_t count = source_.primitives[primitives_[0]].targets.size();
    mesh_.targets.resize(count);
    for (size_t i = 0; i < count; ++i) mesh_.targets[i].name = fmt::format("target{}", i);
    const tinygltf::Value* names = gltf_member(source_.extras, "targetNames");
    // Where VRM has them.
    if (names == nullptr) names = gltf_member(source_.primitives[primitives_[0]].extras, "targetNames");
    if (names != nullptr && names->IsArray() && names->ArrayLen() == count) {
      for (size_t i = 0; i < count; ++i) {
        const tinygltf::Value& name = names->Get(int(i));
        if (name.IsString() && !name.Get<std::string>().empty())
          mesh_.targets[i].name = name.Get<std::string>();
      }
    } else if (names != nullptr) {
      log::warn_once(reader_.file() + " target names",
                     fmt::format("{}: {}: its targetNames are not one a morph target and are ignored",
                                 reader_.file(), label_));
    }
    mesh_.weights = gltf_floats(reader_, source_.weights, label_ + ", weights");
    if (mesh_.weights.empty()) mesh_.weights.resize(count, 0.0f);
    if (mesh_.weights.size() != count) {
      fail_input(reader_.file(), "{}: {} weights for {} morph targets; export it again", label_,
                 mesh_.weights.size(), count);
    }
  }

  void add_primitive(size_t i) {
    const tinygltf::Primitive& primitive = source_.primitives[i];
    const VertexRange range = add_vertices(i);
    std::vector<uint32_t> corners;
    if (primitive.indices >= 0) {
      corners = reader_.indices(primitive.indices, where(i) + ", indices");
    } else {
      reader_.charge(range.count, sizeof(uint32_t), where(i));
      corners.resize(range.count);
      std::iota(corners.begin(), corners.end(), 0u);
    }
    for (uint32_t& corner : corners) {
      if (corner >= range.count) {
        fail_input(reader_.file(), "{}: index {} of {} vertices; export it again", where(i), corner,
                   range.count);
      }
      corner += range.first;
    }
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0) {
      fail_input(reader_.file(), "{}: {} corners are not whole triangles; export it again", where(i),
                 corners.size());
    }
    reader_.charge(corners.size(), sizeof(glm::uvec3), where(i));
    const std::vector<glm::uvec3> triangles = assemble_triangles(primitive.mode, corners);
    const uint32_t material =
        gltf_index(reader_, primitive.material, reader_.model().materials.size(), where(i) + ", material");
    if (triangles.empty()) return;
    if (mesh_.triangles.size() + triangles.size() >= none) {
      fail_input(reader_.file(), "{}: more than {} triangles; split the mesh", label_, none - 1);
    }
    mesh_.parts.push_back({uint32_t(mesh_.triangles.size()), uint32_t(triangles.size()), material});
    flat_.resize(mesh_.triangles.size() + triangles.size(), has(i, "NORMAL") ? 0 : 1);
    mesh_.triangles.insert(mesh_.triangles.end(), triangles.begin(), triangles.end());
  }

  VertexRange add_vertices(size_t i) {
    const tinygltf::Primitive& primitive = source_.primitives[i];
    const VertexSource source(primitive.attributes, primitive.targets);
    if (const auto known = ranges_.find(source); known != ranges_.end()) return known->second;
    const std::vector<glm::vec3> positions =
        reader_.vec3s(primitive.attributes.at("POSITION"), where(i) + ", POSITION");
    const VertexRange range{uint32_t(mesh_.positions.size()), positions.size()};
    if (mesh_.positions.size() + positions.size() >= none) fail_too_many();
    mesh_.positions.insert(mesh_.positions.end(), positions.begin(), positions.end());
    add_attributes(i, range);
    append_morph_targets(reader_, primitive, range.first, range.count, where(i), mesh_.targets);
    if (any_has("JOINTS_0") || any_has("WEIGHTS_0")) {
      append_influences(reader_, primitive, range.count, where(i), mesh_);
    }
    ranges_.emplace(source, range);
    return range;
  }

  // Reads the attribute where any primitive of the mesh has it; those without get `fallback`.
  template <class Vector, class Read>
  void add_attribute(size_t i, const VertexRange& range, const char* name, const Vector& fallback,
                     const Read& read, std::vector<Vector>& all) {
    if (!any_has(name)) return;
    const auto found = source_.primitives[i].attributes.find(name);
    if (found == source_.primitives[i].attributes.end()) {
      reader_.charge(range.count, sizeof(Vector), where(i));
      all.resize(mesh_.positions.size(), fallback);
      return;
    }
    const std::string use = fmt::format("{}, {}", where(i), name);
    if (reader_.count(found->second, use) != range.count) {
      fail_input(reader_.file(), "{}: {} elements for {} vertices; export it again", use,
                 reader_.count(found->second, use), range.count);
    }
    const std::vector<Vector> values = (reader_.*read)(found->second, use);
    all.insert(all.end(), values.begin(), values.end());
  }

  void add_attributes(size_t i, const VertexRange& range) {
    add_attribute(i, range, "NORMAL", glm::vec3(0), &AccessorReader::vec3s, mesh_.normals);
    add_attribute(i, range, "TANGENT", glm::vec4(0), &AccessorReader::vec4s, mesh_.tangents);
    add_attribute(i, range, "TEXCOORD_0", glm::vec2(0), &AccessorReader::vec2s, mesh_.texcoords[0]);
    add_attribute(i, range, "TEXCOORD_1", glm::vec2(0), &AccessorReader::vec2s, mesh_.texcoords[1]);
    add_attribute(i, range, "COLOR_0", glm::vec4(1), &AccessorReader::colors, mesh_.colors);
  }

  bool needs_tangents(const tinygltf::Primitive& primitive) const {
    return primitive.material >= 0 &&
           reader_.model().materials[size_t(primitive.material)].normalTexture.index >= 0;
  }

  // Tangents that only some primitives have are kept where those without do not need them; else all are left
  // to be derived from the texture coordinates.
  void complete_tangents() {
    if (mesh_.tangents.empty()) return;
    for (size_t i : primitives_) {
      const tinygltf::Primitive& primitive = source_.primitives[i];
      if ((has(i, "TANGENT") && has(i, "NORMAL")) || !needs_tangents(primitive)) continue;
      mesh_.tangents.clear();
      return;
    }
    for (size_t v = 0; v < mesh_.tangents.size(); ++v) {
      glm::vec4& tangent = mesh_.tangents[v];
      const glm::vec3 direction(tangent);
      const float length = glm::length(direction);
      const bool usable = length > 0 && std::isfinite(length);
      tangent = glm::vec4(usable ? direction / length : any_perpendicular(mesh_.normals[v]),
                          tangent.w < 0 ? -1 : 1);
    }
  }

  const AccessorReader& reader_;
  const tinygltf::Mesh& source_;
  std::string label_;
  std::vector<size_t> primitives_;
  std::map<VertexSource, VertexRange> ranges_;
  std::vector<uint8_t> flat_;  // of every triangle, whether it is a facet
  Mesh mesh_;
};

}  // namespace

Mesh convert_mesh(const AccessorReader& reader, size_t index) {
  return MeshConverter(reader, index).convert();
}

}  // namespace lodestone::scene
