// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "scene_files.h"

namespace lodestone::scene::test {
namespace {

enum class Encoding { ascii, little, big };

// Writes values in the encoding of a PLY file, each under the name of its type.
class Body {
 public:
  explicit Body(Encoding encoding) : encoding_(encoding) {}

  template <class T>
  Body& add(T value) {
    if (encoding_ == Encoding::ascii) {
      text_ += fmt::format("{}{}", +value, ++values_ % 5 == 0 ? "\n" : " ");
      return *this;
    }
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    const auto order = encoding_ == Encoding::little ? std::endian::little : std::endian::big;
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    text_.append(raw.data(), raw.size());
    return *this;
  }
  template <class T>
  Body& add_all(std::initializer_list<T> values) {
    for (const T value : values) add(value);
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  Encoding encoding_;
  std::string text_;
  int values_ = 0;
};

class Ply : public testing::TestWithParam<Encoding> {
 protected:
  Mesh load(const std::string& declarations, const Body& body) const {
    static constexpr const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const std::string format = names[static_cast<size_t>(GetParam())];
    return load_mesh(folder_.write(
        "model.ply", "ply\nformat " + format + " 1.0\n" + declarations + "end_header\n" + body.text()));
  }
  Body body() const { return Body(GetParam()); }

  TemporaryFolder folder_;
};

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string indices = "property list uchar int vertex_indices\n";

TEST_P(Ply, PolygonsBecomeFansAroundTheirFirstCorner) {
  Body data = body();
  for (const float x : {0.f, 2.f, 3.f, 1.f, -1.f}) data.add_all({x, x * x, 0.f});
  data.add<uint8_t>(5).add_all({4, 3, 2, 1, 0}).add<uint8_t>(2).add_all({0, 1});
  data.add<uint8_t>(3).add_all({0, 1, 2});
  const Mesh mesh = load("comment a pentagon\nelement vertex 5\n" + xyz + "element face 3\n" + indices, data);
  EXPECT_EQ(mesh.name, "model");
  EXPECT_EQ(mesh.positions[4], glm::vec3(-1, 1, 0));
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{4, 3, 2}, {4, 2, 1}, {4, 1, 0}, {0, 1, 2}}));
}

TEST_P(Ply, EveryScalarTypeIsReadUnderBothOfItsNames) {
  Body data = body();
  data.add<int8_t>(-1).add<uint8_t>(200).add<int16_t>(-300).add<uint16_t>(60000).add<int32_t>(-70000);
  data.add<uint32_t>(4000000000u).add(0.5f).add(-0.25).add(1.0f);
  data.add<int8_t>(1).add<uint8_t>(0).add<int16_t>(1).add<uint16_t>(0).add<int32_t>(1);
  data.add<uint32_t>(0).add(0.0f).add(0.0).add(0.0f);
  data.add<int8_t>(0).add<uint8_t>(1).add<int16_t>(0).add<uint16_t>(1).add<int32_t>(0);
  data.add<uint32_t>(1).add(0.0f).add(0.0).add(0.0f);
  Body again = data;
  for (Body* each : {&data, &again}) each->add<uint8_t>(3).add_all({0, 1, 2});
  const std::string rest = "element face 1\n" + indices;
  const Mesh first = load(
      "element vertex 3\nproperty char x\nproperty uchar y\nproperty short a1\nproperty ushort a2\nproperty "
      "int a3\n"
      "property uint a4\nproperty float a5\nproperty double z\nproperty float a6\n" +
          rest,
      data);
  EXPECT_EQ(first.positions[0], glm::vec3(-1, 200, -0.25f));
  const Mesh second = load(
      "element vertex 3\nproperty int8 a1\nproperty uint8 a2\nproperty int16 x\nproperty uint16 y\nproperty "
      "int32 z\n"
      "property uint32 a4\nproperty float32 a5\nproperty float64 a6\nproperty float32 a7\n" +
          rest,
      again);
  EXPECT_EQ(second.positions[0], glm::vec3(-300, 60000, -70000));
}

TEST_P(Ply, PropertiesAndElementsInAnyOrderAndUnknownOnesArePassedOver) {
  Body data = body();
  data.add<uint16_t>(2).add_all({1.5, 2.5}).add<uint8_t>(3).add_all<uint16_t>({2, 1, 0}).add<int8_t>(-7);
  data.add_all<int16_t>({1, 2});  // element edge
  for (const float value : {1.f, 2.f, 3.f}) {
    data.add(value).add<uint32_t>(1).add<int8_t>(5).add_all({value * value, 0.f});
  }
  const Mesh mesh = load(
      "obj_info x\nelement face 1\nproperty list ushort double weights\nproperty list uint8 ushort "
      "vertex_index\n"
      "property char flag\nelement edge 1\nproperty short a\nproperty short b\nelement nothing 4000000000\n"
      "element vertex 3\nproperty float z\nproperty list uint char tags\nproperty float x\nproperty float "
      "y\n",
      data);
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{1, 0, 1}, {4, 0, 2}, {9, 0, 3}}));
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{2, 1, 0}}));
}

TEST_P(Ply, NormalsColoursAndTextureCoordinatesAreRead) {
  Body data = body();
  for (int i = 0; i < 3; ++i) {
    data.add_all({float(i), float(i * i), 0.f}).add_all({0., 3., 4.}).add_all<uint8_t>({255, 0, 188, 51});
    data.add_all({0.25f, 0.75f});
  }
  data.add<uint8_t>(3).add_all({0, 1, 2});
  const std::string declarations =
      "element vertex 3\n" + xyz +
      "property double nx\nproperty double ny\nproperty double nz\nproperty uchar red\n" +
      "property uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float U\nproperty float "
      "V\n" +
      "element face 1\n" + indices;
  for (const auto& [u, v] :
       {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    std::string named = declarations;
    named.replace(named.find("U\n"), 1, u);
    named.replace(named.find("V\n"), 1, v);
    const Mesh mesh = load(named, data);
    ASSERT_EQ(mesh.texcoords[0].size(), 3u) << u;
    EXPECT_EQ(mesh.texcoords[0][0], glm::vec2(0.25f, 0.25f)) << "counted from the bottom";
    EXPECT_TRUE(near(mesh.normals[1], {0, 0.6f, 0.8f}));
    ASSERT_EQ(mesh.colors.size(), 3u);
    // 188 is the sRGB code whose light is nearest to a half: ((188 / 255 + 0.055) / 1.055) ^ 2.4.
    EXPECT_TRUE(near(mesh.colors[2], {1, 0, 0.502886f}, 1e-5f));
    EXPECT_FLOAT_EQ(mesh.colors[2].a, 0.2f);
  }
}

TEST_P(Ply, FloatingPointColoursAreLinear) {
  Body data = body();
  for (int i = 0; i < 3; ++i) data.add_all({float(i), float(i * i), 0.f, 0.25f, 0.5f, 2.0f});
  data.add<uint8_t>(3).add_all({0, 1, 2});
  const Mesh mesh =
      load("element vertex 3\n" + xyz + "property float red\nproperty float green\nproperty float blue\n" +
               "element face 1\n" + indices,
           data);
  EXPECT_EQ(mesh.colors.at(0), glm::vec4(0.25f, 0.5f, 2, 1));
}

TEST_P(Ply, MissingNormalsAreSmooth) {
  Body data = body();
  for (const auto& p :
       {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(0)}) {
    data.add_all({p.x, p.y, p.z});
  }
  data.add<uint8_t>(3).add_all({0, 1, 2}).add<uint8_t>(3).add_all({4, 2, 3});
  const Mesh mesh = load("element vertex 5\n" + xyz + "element face 2\n" + indices, data);
  EXPECT_TRUE(near(mesh.normals[0], glm::normalize(glm::vec3(1, 0, 1))))
      << "vertices 0 and 4 are at one position";
  EXPECT_EQ(mesh.normals[4], mesh.normals[0]);
  EXPECT_TRUE(near(mesh.normals[3], {1, 0, 0}));
}

std::string name_of(const testing::TestParamInfo<Encoding>& encoding) {
  static constexpr const char* names[] = {"ascii", "little_endian", "big_endian"};
  return names[static_cast<size_t>(encoding.param)];
}

INSTANTIATE_TEST_SUITE_P(Encodings, Ply, testing::Values(Encoding::ascii, Encoding::little, Encoding::big),
                         name_of);

// The first byte of the data is the code of \n: it must not be taken for a part of the header's last line
// end.
TEST(PlyHeader, LinesMayEndInAnyWay) {
  const TemporaryFolder folder;
  const std::string lines =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\nproperty "
      "uchar z\n"
      "element face 1\n" +
      indices + "end_header\n";
  Body data(Encoding::little);
  data.add_all<uint8_t>({'\n', 0, 0, 1, 0, 0, 0, 1, 0}).add<uint8_t>(3).add_all({0, 1, 2});
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string header;
    for (const char c : lines) header += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(load_mesh(folder.write("m.ply", header + data.text())).positions[0], glm::vec3('\n', 0, 0));
  }
}

}  // namespace
}  // namespace lodestone::scene::test
