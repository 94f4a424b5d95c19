// SPDX-License-Identifier: MIT
// STL, ASCII and binary. All solids of a file become one mesh in the order of their facets. The facets' own
// normals and the two bytes that some programs fill with a colour are passed over: normals follow from the
// corners.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/crease_normals.h"
#include "lodestone/scene/load.h"
#include "lodestone/scene/mesh_tools.h"
#include "lodestone/scene/single_mesh.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

constexpr size_t header_size = 80, preamble_size = header_size + 4, facet_size = 50, normal_size = 12;
// Round things made of 10 or more segments look round, the edges of a hexagonal nut do not.
constexpr double crease_angle = 40 * std::numbers::pi / 180;

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian and read as it is");

uint32_t declared_facets(std::string_view bytes) {
  uint32_t count = 0;
  std::memcpy(&count, bytes.data() + header_size, sizeof(count));
  return count;
}

// Many binary files begin with `solid` too. A file of exactly the size that its count asks for is binary; any
// other is ASCII where what follows the line of `solid` is a facet or the end.
bool is_ascii(const std::string& file, std::string_view bytes) {
  if (bytes.size() >= preamble_size &&
      bytes.size() == preamble_size + facet_size * uint64_t(declared_facets(bytes))) {
    return false;
  }
  TextReader reader(file, bytes);
  if (!equal_ignoring_case(reader.word_across_lines(), "solid")) return false;
  const std::string_view second = reader.next_line() ? reader.word_across_lines() : "";
  if (second.empty()) return bytes.find('\0') == std::string_view::npos;  // cut off early
  return equal_ignoring_case(second, "facet") || equal_ignoring_case(second, "endsolid");
}

std::vector<glm::vec3> read_binary(const std::string& file, std::string_view bytes) {
  if (bytes.size() < preamble_size) {
    fail_input(file,
               "byte {}: the file ends inside the first {} bytes, before its facets; get the whole file",
               bytes.size(), preamble_size);
  }
  const uint64_t count = declared_facets(bytes), room = (bytes.size() - preamble_size) / facet_size;
  if (count > room) {
    fail_input(file,
               "byte {}: declares {} facets, but has room for {}; the file is cut off or no STL file, get "
               "the whole file",
               header_size, count, room);
  }
  if (bytes.size() > preamble_size + count * facet_size) {
    log::warn(fmt::format("{}: the bytes behind the {} facets that it declares are left out", file, count));
  }
  std::vector<glm::vec3> corners(3 * count);
  for (uint64_t facet = 0; facet < count; ++facet) {
    const uint64_t place = preamble_size + facet * facet_size + normal_size;
    std::memcpy(&corners[3 * facet], bytes.data() + place, 3 * sizeof(glm::vec3));
    for (uint64_t i = 3 * facet; i < 3 * facet + 3; ++i) {
      if (!std::isfinite(corners[i].x) || !std::isfinite(corners[i].y) || !std::isfinite(corners[i].z)) {
        fail_input(file,
                   "byte {}: facet {} has a coordinate that is not a finite number; export the file again",
                   place, facet);
      }
    }
  }
  return corners;
}

class AsciiParser {
 public:
  AsciiParser(const std::string& file, std::string_view text) : reader_(file, text) {}

  std::vector<glm::vec3> parse() {
    for (;;) {
      const std::string_view word = reader_.word_across_lines();
      if (word.empty()) break;
      if (equal_ignoring_case(word, "solid") && !inside_) {
        reader_.rest_of_line();
        inside_ = true;
      } else if (equal_ignoring_case(word, "endsolid") && inside_) {
        reader_.rest_of_line();
        inside_ = false;
      } else if (equal_ignoring_case(word, "facet") && inside_) {
        parse_facet();
      } else {
        reader_.fail("`{}` where {} was expected; export the file again", printable(word),
                     inside_ ? "`facet` or `endsolid`" : "`solid`");
      }
    }
    if (inside_) reader_.fail("the file ends before `endsolid`; get the whole file");
    return std::move(corners_);
  }

 private:
  void parse_facet() {
    expect("normal");
    // Passed over unread: exporters write `nan` for facets without an area.
    for (int i = 0; i < 3; ++i) reader_.word_across_lines();
    expect("outer");
    expect("loop");
    for (int i = 0; i < 3; ++i) {
      expect("vertex");
      const float x = read_coordinate(), y = read_coordinate(), z = read_coordinate();
      corners_.emplace_back(x, y, z);
    }
    expect("endloop");
    expect("endfacet");
  }

  float read_coordinate() {
    return reader_.to_float(reader_.word_across_lines(), "a coordinate of a vertex");
  }

  void expect(std::string_view keyword) {
    const std::string_view word = reader_.word_across_lines();
    if (equal_ignoring_case(word, keyword)) return;
    if (word.empty()) reader_.fail("the file ends where `{}` was expected; get the whole file", keyword);
    reader_.fail("`{}` where `{}` was expected; export the file again as triangles", printable(word),
                 keyword);
  }

  TextReader reader_;
  std::vector<glm::vec3> corners_;
  bool inside_ = false;
};

std::vector<glm::vec3> read_corners(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::vector<std::byte> contents = read_file(path);
  const std::string_view bytes = as_text(contents);
  if (bytes.empty()) fail_input(file, "is empty; expected an STL file");
  return is_ascii(file, bytes) ? AsciiParser(file, bytes).parse() : read_binary(file, bytes);
}

}  // namespace

Scene load_stl(const std::filesystem::path& path) {
  const std::vector<glm::vec3> corners = read_corners(path);
  if (corners.empty()) fail_input(path.string(), "has no facets; export the file again");
  if (corners.size() >= none) fail_too_many(path.string());
  Mesh mesh;
  build_creased_mesh(corners, crease_angle, mesh);
  complete_normals(mesh);
  return single_mesh_scene(path, std::move(mesh));
}

}  // namespace lodestone::scene
