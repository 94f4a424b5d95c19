// SPDX-License-Identifier: MIT
// Broken files, one fault each, and what is said about them: where the fault is and what it is.
#include <sys/resource.h>

#include <string>
#include <vector>

#include "scene_files.h"

namespace lodestone::scene::test {
namespace {

struct Malformed {
  const char* test;
  const char* extension;
  std::string bytes;
  std::string message;  // how it begins
};

void PrintTo(const Malformed& file, std::ostream* stream) {
  *stream << file.test;
}

std::string stl_with(uint32_t facets, const std::string& body, const std::string& header = "") {
  std::string bytes = header;
  bytes.resize(80);
  for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(facets >> (8 * byte));
  return bytes + body;
}

std::string ply_with(const std::string& declarations, const std::string& body = "") {
  return "ply\nformat ascii 1.0\n" + declarations + "end_header\n" + body;
}

const std::string nul(1, '\0');
const std::string vertices3 = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string face1 = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string triangle = "element vertex 3\n" + xyz + face1;
const std::string facet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n";

const std::vector<Malformed> files{
    {"ObjEmpty", ".obj", "", "holds no vertex"},
    {"ObjOfBytes", ".obj", nul + "\xff\xfe\x01", "holds no vertex"},
    {"ObjWithoutFaces", ".obj", vertices3, "has no faces"},
    {"ObjCutOffInAFace", ".obj", vertices3 + "f 1 2 3\nf 1 2",
     "line 5: the file ends in the middle of a face"},
    {"ObjCoordinateMissing", ".obj", vertices3 + "v 1 2\nf 1 2 3\n", "line 4: a coordinate of v is missing"},
    {"ObjNan", ".obj", "v 0 nan 0\nf 1 1 1\n", "line 1: a coordinate of v `nan` is not a finite number"},
    {"ObjInfinity", ".obj", "v 0 0 -inf\n", "line 1: a coordinate of v `-inf` is not a finite number"},
    {"ObjBeyondFloat", ".obj", "v 1e39 0 0\n", "line 1: a coordinate of v `1e39` is not a finite number"},
    {"ObjBeyondDouble", ".obj", "v 1e999 0 0\n", "line 1: a coordinate of v `1e999` is not a number"},
    {"ObjWordForNumber", ".obj", "v 0 zero 0\n", "line 1: a coordinate of v `zero` is not a number"},
    {"ObjNumberWithTail", ".obj", "\nvn 0 1,5 0\n", "line 2: a coordinate of vn `1,5` is not a number"},
    {"ObjTexcoordMissing", ".obj", "vt\n", "line 1: a coordinate of vt is missing"},
    {"ObjIndexZero", ".obj", vertices3 + "f 0 1 2\n", "line 4: index 0 in a face"},
    {"ObjIndexTooLarge", ".obj", vertices3 + "f 1 2 3\nf 1 2 4\n",
     "line 5: a face names v 4, but the file has 3"},
    {"ObjIndexTooSmall", ".obj", vertices3 + "f 1 2 -4\n", "line 4: index -4 in a face counts back behind"},
    {"ObjIndexAbsurd", ".obj", vertices3 + "f 1 2 4294967296\n",
     "line 4: index 4294967296 in a face is out of range"},
    {"ObjIndexBeyondAll", ".obj", vertices3 + "f 1 2 99999999999999999999\n",
     "line 4: an index `99999999999999999999` is not"},
    {"ObjIndexLowestInteger", ".obj", vertices3 + "f 1 2 -9223372036854775808\n",
     "line 4: index -9223372036854775808"},
    {"ObjTexcoordIndexTooLarge", ".obj", vertices3 + "f 1/1 2 3\n",
     "line 4: a face names vt 1, but the file has 0"},
    {"ObjNormalIndexTooLarge", ".obj", vertices3 + "vn 0 0 1\nf 1//1 2//2 3\n",
     "line 5: a face names vn 2, but the file has 1"},
    {"ObjFourIndices", ".obj", vertices3 + "f 1/1/1/1 2 3\n", "line 4: "},
    {"ObjNoVertexInCorner", ".obj", vertices3 + "f /1 2 3\n", "line 4: "},
    {"ObjIndexNoInteger", ".obj", vertices3 + "f 1.5 2 3\n", "line 4: an index `1.5` is not an integer"},
    {"ObjContinuedLine", ".obj", vertices3 + "f 1 \\\n2 x\n", "line 5: an index `x` is not an integer"},

    {"PlyEmpty", ".ply", "", "is empty"},
    {"PlyNoMagic", ".ply", "plyx\n", "line 1: is not a PLY file"},
    {"PlyHeaderCutOff", ".ply", "ply\nformat ascii 1.0\n", "line 2: the file ends inside its header"},
    {"PlyUnknownFormat", ".ply", "ply\nformat morse 1.0\nend_header\n", "line 2: unknown format `morse`"},
    {"PlyUnknownVersion", ".ply", "ply\nformat ascii 2.0\nend_header\n", "line 2: unknown version `2.0`"},
    {"PlyNoFormat", ".ply", "ply\nend_header\n", "line 2: the header declares no format"},
    {"PlyTwoFormats", ".ply", "ply\nformat ascii 1.0\nformat ascii 1.0\nend_header\n",
     "line 3: the format is declared twice"},
    {"PlyUnknownKeyword", ".ply", ply_with("elephant vertex 3\n"), "line 3: `elephant` is no keyword"},
    {"PlyUnknownType", ".ply", ply_with("element vertex 3\nproperty half x\n"),
     "line 4: unknown type `half`"},
    {"PlyNamelessProperty", ".ply", ply_with("element vertex 3\nproperty float\n"),
     "line 4: a property has no name"},
    {"PlyPropertyFirst", ".ply", ply_with("property float x\n"),
     "line 3: a property stands before the first element"},
    {"PlyCountNegative", ".ply", ply_with("element vertex -3\n"),
     "line 3: element vertex has the negative count -3"},
    {"PlyCountNoNumber", ".ply", ply_with("element vertex many\n"), "line 3: the count of an element `many`"},
    {"PlyElementTwice", ".ply", ply_with("element vertex 3\nelement vertex 3\n"),
     "line 4: element vertex is declared twice"},
    {"PlyNoVertices", ".ply", ply_with(face1, "3 0 1 2\n"), "has no vertices"},
    {"PlyVerticesOnly", ".ply", ply_with("element vertex 1\n" + xyz, "0 0 0\n"), "has vertices but no faces"},
    {"PlyNoPositions", ".ply", ply_with("element vertex 1\nproperty float x\n" + face1, "0\n3 0 0 0\n"),
     "element vertex has no properties x, y and z"},
    {"PlyVertexWithoutProperties", ".ply", ply_with("element vertex 1\n" + face1, "3 0 0 0\n"),
     "element vertex has no properties"},
    {"PlyNoIndices", ".ply",
     ply_with("element vertex 1\n" + xyz + "element face 1\nproperty int a\n", "0 0 0\n1\n"),
     "element face has no list vertex_indices"},
    {"PlyFaceWithoutProperties", ".ply", ply_with("element vertex 1\n" + xyz + "element face 1\n", "0 0 0\n"),
     "element face has no list vertex_indices"},
    {"PlyCountAbsurd", ".ply", ply_with("element vertex 4000000000\n" + xyz + face1, "0 0 0\n"),
     "element vertex declares 4000000000 records"},
    {"PlyCountBeyondAll", ".ply", ply_with("element vertex 9223372036854775807\n" + xyz + face1),
     "element vertex declares 9223372036854775807"},
    {"PlyFaceCountAbsurd", ".ply",
     ply_with(
         "element vertex 1\n" + xyz + "element face 4000000000\nproperty list uchar int vertex_indices\n",
         "0 0 0\n"),
     "element face declares 4000000000 records"},
    {"PlyOtherCountAbsurd", ".ply", ply_with("element x 4000000000\nproperty int a\n" + triangle),
     "element x declares 4000000000 records"},
    {"PlyTextCutOff", ".ply", ply_with(triangle, "0 0 0 1 0 0 0 1 0\n3 0 1\n"),
     "line 12: the file ends before all"},
    {"PlyTextNoNumber", ".ply", ply_with(triangle, "0 0 0 1 0 0\n0 one 0\n3 0 1 2\n"),
     "line 11: `one` is not a number"},
    {"PlyNan", ".ply", ply_with(triangle, "0 0 0 1 nan 0 0 1 0\n3 0 1 2\n"),
     "line 10: y of vertex 1 is not a finite number"},
    {"PlyBeyondFloat", ".ply", ply_with(triangle, "0 0 1e39 1 0 0 0 1 0\n3 0 1 2\n"),
     "line 10: z of vertex 0 is not a finite number"},
    {"PlyIndexTooLarge", ".ply", ply_with(triangle, "0 0 0 1 0 0 0 1 0\n3 0 1 3\n"),
     "line 11: face 0 names vertex 3, but"},
    {"PlyIndexNegative", ".ply", ply_with(triangle, "0 0 0 1 0 0 0 1 0\n3 0 1 -1\n"),
     "line 11: face 0 names vertex -1, but"},
    {"PlyIndexFraction", ".ply", ply_with(triangle, "0 0 0 1 0 0 0 1 0\n3 0 1 0.5\n"),
     "line 11: face 0 names vertex 0.5, but"},
    {"PlyListNegative", ".ply", ply_with(triangle, "0 0 0 1 0 0 0 1 0\n-3 0 1 2\n"),
     "line 11: list vertex_indices has -3 items"},
    {"PlyListAbsurd", ".ply", ply_with(triangle, "0 0 0 1 0 0 0 1 0\n4000000000 0 1 2\n"), "line 1"},
    {"PlyOnlyEdges", ".ply", ply_with(triangle, "0 0 0 1 0 0 0 1 0\n2 0 1\n"),
     "has no face of 3 or more corners"},
    {"PlyBinaryCutOff", ".ply",
     "ply\nformat binary_little_endian 1.0\n" + triangle + "end_header\n" + std::string(36, '\0') + "\3" +
         std::string(11, '\0'),
     "byte 217: the file ends before all"},
    {"PlyBinarySkippedListCutOff", ".ply",
     "ply\nformat binary_big_endian 1.0\nelement a 1\nproperty list uint double b\nelement vertex "
     "1\nproperty list uchar int c\n" +
         xyz + face1 + "end_header\n" + std::string(40, '\x7f'),
     "byte "},

    {"StlEmpty", ".stl", "", "is empty"},
    {"StlTooShort", ".stl", std::string(83, 'x'), "byte 83: the file ends inside the first 84 bytes"},
    {"StlNoFacets", ".stl", stl_with(0, ""), "has no facets"},
    {"StlCountAbsurd", ".stl", stl_with(0xffffffff, std::string(50, '\0')),
     "byte 80: declares 4294967295 facets, but has room for 1"},
    {"StlCutOff", ".stl", stl_with(2, std::string(99, '\0'), "solid"),
     "byte 80: declares 2 facets, but has room for 1"},
    {"StlNan", ".stl", stl_with(1, std::string(12, '\0') + std::string(38, '\xff')),
     "byte 96: facet 0 has a coordinate that is not"},
    {"StlAsciiEmpty", ".stl", "solid nothing\nendsolid nothing\n", "has no facets"},
    {"StlAsciiCutOff", ".stl", "solid\n" + facet, "line 8: the file ends where `endfacet` was expected"},
    {"StlAsciiNoEnd", ".stl", "solid\n" + facet + "endfacet\n", "line 9: the file ends before `endsolid`"},
    {"StlAsciiNan", ".stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n",
     "line 4: a coordinate of a vertex `nan`"},
    {"StlAsciiFourCorners", ".stl",
     "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n",
     "line 7: `vertex` where `endloop` was expected"},
    {"StlAsciiGarbage", ".stl", "solid\n" + facet + "endfacet\nfacet abnormal",
     "line 9: `abnormal` where `normal` was expected"},
    {"StlAsciiOutside", ".stl", "solid\n" + facet + "endfacet\nendsolid\nfacet",
     "line 10: `facet` where `solid` was expected"},

    {"PngCutOff", ".png", "\x89PNG\r\n\x1a\n", "is a PNG that is cut short at byte 8"},
    {"ExrCutOff", ".exr", "\x76\x2f\x31\x01\2", "byte 5: the file ends inside its header"},
    {"ExrAttributeCutOff", ".exr", "\x76\x2f\x31\x01\2" + std::string(3, '\0') + "a",
     "byte 9: the file ends inside its"},
    {"ExrAttributeAbsurd", ".exr",
     "\x76\x2f\x31\x01\2" + std::string(3, '\0') + "a" + nul + "b" + nul + "\xff\xff\xff\x7f" + nul,
     "byte 12: an attribute claims 2147483647 bytes, but 1 are left"},
    {"ExrAttributeOfWrongSize", ".exr",
     "\x76\x2f\x31\x01\2" + std::string(3, '\0') + "a" + nul + "float" + nul + "\3" + std::string(9, '\0'),
     "byte 16: an attribute claims 3 bytes, which its type does not have"},
    {"ExrChannelsOfWrongSize", ".exr",
     "\x76\x2f\x31\x01\2" + std::string(3, '\0') + "a" + nul + "chlist" + nul + "\5" + std::string(9, '\0'),
     "byte 17: an attribute claims 5 bytes, which its type does not have"},
    {"ExrWindowAbsurd", ".exr",
     "\x76\x2f\x31\x01\2" + std::string(3, '\0') + "dataWindow" + nul + "box2i" + nul + "\x10" +
         std::string(3, '\0') + std::string(3, '\0') + "\x80" + std::string(4, '\0') + "\xff\xff\xff\x7f\1" +
         std::string(4, '\0'),
     "has 4294967296 x 2 samples, more than 134217728 in all"},
    {"ExrDeep", ".exr", "\x76\x2f\x31\x01\2\x08" + std::string(9, '\0'),
     "byte 4: is an OpenEXR file of several"},
    {"TiffCutOff", ".tif", "II*" + nul, "cannot be decoded"},
};

class MalformedFile : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedFile, IsRefusedWithPlaceAndReason) {
  const TemporaryFolder folder;
  const std::string message =
      bad_input_message(folder.write(std::string("m") + GetParam().extension, GetParam().bytes));
  EXPECT_TRUE(message.starts_with(GetParam().message)) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << "messages are one line";
}

INSTANTIATE_TEST_SUITE_P(Files, MalformedFile, testing::ValuesIn(files),
                         [](const testing::TestParamInfo<Malformed>& file) {
                           return std::string(file.param.test);
                         });

// Counts are checked against the size of the file before room is made for them.
TEST(MalformedFiles, TakeLittleMemory) {
  const auto peak_megabytes = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
  };
  const long before = peak_megabytes();
  const TemporaryFolder folder;
  for (const Malformed& file : files)
    bad_input_message(folder.write(std::string("m") + file.extension, file.bytes));
  EXPECT_LT(peak_megabytes() - before, 64);
}

TEST(MalformedFiles, ThatAreNotThereOrNoFilesAreRefused) {
  const TemporaryFolder folder;
  for (const char* extension : {".obj", ".ply", ".stl", ".png"}) {
    const std::filesystem::path missing = folder.path() / (std::string("missing") + extension);
    EXPECT_TRUE(bad_input_message(missing).starts_with("no such file"));
    std::filesystem::create_directory(missing);
    EXPECT_TRUE(bad_input_message(missing).starts_with("is not a regular file"));
  }
}

}  // namespace
}  // namespace lodestone::scene::test
