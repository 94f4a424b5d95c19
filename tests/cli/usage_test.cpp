// SPDX-License-Identifier: MIT
// Wrong usage ends with exit code 2, a bad file with 3, and one line that says what to do.
#include <algorithm>

#include "process.h"

namespace lodestone::cli {
namespace {

struct Wrong {
  const char* name;
  std::vector<std::string> arguments;
  std::vector<std::string> said;  // parts of the message
};

void PrintTo(const Wrong& wrong, std::ostream* stream) {
  *stream << wrong.name;
}

void expect_one_error(const Result& result, int code, const std::vector<std::string>& said) {
  EXPECT_EQ(result.code, code) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err.rfind("lodestone: error: ", 0), 0u) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  for (const std::string& part : said)
    EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n" << result.err;
}

class WrongUsage : public testing::TestWithParam<Wrong> {};

TEST_P(WrongUsage, IsRefusedWithAMessage) {
  expect_one_error(run(GetParam().arguments), 2, GetParam().said);
}

// A render with one more option.
std::vector<std::string> with(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"render", "builtin:tiny", "-o", "/tmp/lodestone-never-written.png"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

const Wrong wrong_values[] = {
    {"NoCommand", {}, {"command"}},
    {"UnknownCommand", {"rendr"}, {"rendr", "render", "devices"}},
    {"UnknownTarget", with({"--weights", "Fould=1"}), {"no morph target 'Fould'", "did you mean 'fold'?"}},
    {"UnknownOption", with({"--sice", "8x8"}), {"--sice", "did you mean --size?", "render --help"}},
    {"OptionUnlikeAnyOther", with({"--raytrace"}), {"--raytrace: there is no such option; see"}},
    {"NoScene", {"render", "-o", "x.png"}, {"SCENE"}},
    {"NoOutput", {"render", "builtin:tiny"}, {"--output"}},
    {"UnknownBuiltin", {"render", "builtin:moon", "-o", "/tmp/x.png", "--device", "cpu"}, {"moon", "tiny"}},
    {"OutputWithoutExtension", {"render", "builtin:tiny", "-o", "picture"}, {"picture", ".exr", ".png"}},
    {"OutputOfAnotherKind", {"render", "builtin:tiny", "-o", "picture.jpg"}, {"picture.jpg", ".png"}},
    {"SeveralRunsOfMarks", {"render", "builtin:tiny", "-o", "a##b##.png"}, {"several runs"}},
    {"SequenceWithoutMark", with({"--frames", "0-3"}), {"####", "4 frames"}},
    {"OrbitOfOneNumber", with({"--orbit", "5"}), {"--orbit", "`5`", "2 numbers"}},
    {"OrbitOverTheTop", with({"--orbit", "5,91"}), {"--orbit", "-90 and 90"}},
    {"CameraAtNoPlace", with({"--camera-at", "1,2"}), {"--camera-at", "3 numbers"}},
    {"CameraFromNoNumber", with({"--camera-from", "1,2,x"}), {"--camera-from", "`x`"}},
    {"CameraInItsTarget", with({"--camera-from", "1,2,3", "--camera-at", "1,2,3"}), {"two places"}},
    {"FovOfNothing", with({"--fov", "0"}), {"--fov", "179"}},
    {"SegmentsWithoutShutter", with({"--shutter-segments", "4"}), {"--shutter-segments", "--shutter"}},
    {"SegmentsBeyondAll", with({"--shutter", "1", "--shutter-segments", "65"}), {"65", "64"}},
    {"ShutterBelowZero", with({"--shutter", "-1"}), {"--shutter", "-1"}},
    {"ShutterOfInstances", with({"--shutter", "1", "--instancing", "on"}), {"--instancing", "off"}},
    {"DeviceMemoryOfNoSize", with({"--device-memory", "1.5G"}), {"--device-memory", "1.5G", "800M"}},
    {"DeviceMemoryOfNothing", with({"--device-memory", "0"}), {"--device-memory", "`0`"}},
    {"DeviceMemoryOfAUnit", with({"--device-memory", "G"}), {"--device-memory", "`G`"}},
    {"DeviceMemoryTooLittle", with({"--device-memory", "1M"}), {"--device-memory", "at least"}},
    {"TerrainOfNoSize", {"info", "builtin:terrain:7x"}, {"builtin:terrain:7x", "16", "8192"}},
    {"TerrainTooLarge", {"info", "builtin:terrain:9000"}, {"builtin:terrain:9000", "8192"}},
    {"ProgressiveAndDenoised",
     with({"--progressive", "--denoise", "--spp", "4"}),
     {"--progressive", "--denoise"}},
    {"PixelsOfErrorBelowZero", with({"--pixels-of-error", "-1"}), {"--pixels-of-error", "-1", "1000"}},
    {"PixelsOfErrorOfInstances",
     with({"--pixels-of-error", "1", "--instancing", "on"}),
     {"--pixels-of-error", "--instancing", "off"}},
    {"PixelsOfErrorInMotion",
     with({"--pixels-of-error", "1", "--shutter", "1"}),
     {"--pixels-of-error", "--shutter"}},
    {"SizeWithoutCross", with({"--size", "512"}), {"--size", "512", "640x360"}},
    {"SizeWithoutHeight", with({"--size", "8x"}), {"--size", "`8x`"}},
    {"SizeZero", with({"--size", "0x8"}), {"--size", "65536"}},
    {"SizeTooLarge", with({"--size", "65537x1"}), {"--size", "65536"}},
    {"SizeOfTooManyPixels", with({"--size", "65536x65536"}), {"--size", "pixels"}},
    {"SizeWithSpace", with({"--size", "8x 8"}), {"--size"}},
    {"SppZero", with({"--spp", "0"}), {"--spp", "65536"}},
    {"SppNegative", with({"--spp", "-1"}), {"--spp"}},
    {"SppFraction", with({"--spp", "1.5"}), {"--spp"}},
    {"SppTooLarge", with({"--spp", "65537"}), {"--spp"}},
    {"FramesBackwards", with({"--frames", "4-3"}), {"--frames", "4-3"}},
    {"FramesNoNumber", with({"--frames", "a-b"}), {"--frames"}},
    {"FpsZero", with({"--fps", "0"}), {"--fps"}},
    {"FpsNotFinite", with({"--fps", "inf"}), {"--fps", "finite"}},
    {"TimeNotANumber", with({"--time", "nan"}), {"--time", "finite"}},
    {"TimeNegative", with({"--time", "-1"}), {"--time"}},
    {"TimeForManyFrames",
     {"render", "builtin:tiny", "-o", "/tmp/x##.png", "--time", "1", "--frames", "0-3"},
     {"--time", "--frames"}},
    {"ExposureOverflow", with({"--exposure", "1e999"}), {"--exposure"}},
    {"UnknownTracer", with({"--tracer", "bvh"}), {"--tracer", "bvh", "geometry-image"}},
    {"UnknownTraversal", with({"--traversal", "fast"}), {"--traversal", "threaded"}},
    {"UnknownAtlas", with({"--atlas", "octahedron"}), {"--atlas", "exact"}},
    {"ResolutionOfAnExactAtlas",
     with({"--atlas", "exact", "--resolution", "256"}),
     {"--resolution", "exact"}},
    {"ResolutionOfAGridAtlas",
     with({"--atlas", "grid", "--resolution", "256"}),
     {"--resolution", "exact", "use --atlas charts or auto"}},
    {"BudgetOfAnExactAtlas",
     with({"--atlas", "exact", "--texel-budget", "256"}),
     {"--texel-budget: ", "no resolution"}},
    {"ResolutionWhereAllAreGrids",
     with({"--device", "cpu", "--resolution", "256"}),
     {"--resolution: all meshes of `builtin:tiny` are grids", "use --atlas charts"}},
    {"SignalWhereAllAreGrids", {"info", "builtin:tiny", "--signal", "curvature"}, {"--signal: all meshes"}},
    {"ShapesWhereAllAreGrids",
     {"bake", "builtin:tiny", "-o", "/tmp/x.lode", "--all-shapes", "--atlas", "auto"},
     {"--all-shapes: all meshes"}},
    {"SignalOfAnExactAtlas", with({"--atlas", "exact", "--signal", "curvature"}), {"--signal", "exact"}},
    {"ShapesOfAnExactAtlas", with({"--atlas", "exact", "--all-shapes"}), {"--all-shapes", "exact"}},
    {"UnknownSignal", with({"--signal", "colour"}), {"--signal", "curvature"}},
    {"TexelBudgetTooSmall", with({"--texel-budget", "3"}), {"--texel-budget"}},
    {"TwoBudgets", with({"--texel-budget", "300", "--resolution", "33"}), {"--texel-budget", "--resolution"}},
    {"UnknownView", with({"--view", "aces"}), {"--view", "filmic"}},
    {"UnknownAov",
     {"render", "builtin:tiny", "-o", "x.exr", "--aov", "depth,color"},
     {"--aov", "color", "albedo"}},
    {"AovTwice", {"render", "builtin:tiny", "-o", "x.exr", "--aov", "depth,depth"}, {"--aov", "twice"}},
    {"AovInPng", with({"--aov", "depth"}), {"--aov", ".exr"}},
    {"NoisyWithoutDenoise",
     {"render", "builtin:tiny", "-o", "x.exr", "--aov", "noisy"},
     {"--aov", "--denoise"}},
    {"DenoiseOneSample", with({"--device", "cpu", "--denoise"}), {"--denoise", "--spp"}},
    {"UnknownProgress", with({"--progress", "bar"}), {"--progress", "json"}},
    {"WeightWithoutValue", with({"--weights", "fold"}), {"--weights", "NAME=NUMBER"}},
    {"WeightNotANumber", with({"--weights", "fold=x"}), {"--weights"}},
    {"UnknownWeight", with({"--device", "cpu", "--weights", "smile=1"}), {"smile", "fold"}},
    {"UnknownClip", with({"--device", "cpu", "--clip", "Run"}), {"Run", "Fold"}},
    {"UnknownCamera", with({"--device", "cpu", "--camera", "Back"}), {"Back", "Front"}},
    {"ThreadsZero", with({"--threads", "0"}), {"--threads"}},
    {"ResolutionZero", with({"--resolution", "0"}), {"--resolution"}},
    {"SeedTooLarge", with({"--seed", "4294967296"}), {"--seed", "4294967295"}},
    {"HeightOfAMesh", with({"--device", "cpu", "--height", "2"}), {"--height", "no height map"}},
    {"ValueTwice", with({"--seed", "1", "--seed", "2"}), {"--seed: is given more than once", "--help"}},
    {"ValueMissing", with({"--seed"}), {"--seed: its value is missing", "--help"}},
    {"EmptyScene", {"render", "", "-o", "/tmp/x.png"}, {"SCENE", "empty"}},
    {"EmptyOutput", {"render", "builtin:tiny", "-o", ""}, {"--output", "empty"}},
    {"EmptyStatistics", with({"--stats", ""}), {"--stats", "empty"}},
    {"EmptyProfile", with({"--profile", ""}), {"--profile", "empty"}},
    {"EmptyContactSheet", with({"--contact-sheet", ""}), {"--contact-sheet", "empty"}},
    {"EmptyCamera", with({"--camera", ""}), {"--camera", "empty"}},
    {"EmptyClip", with({"--clip", ""}), {"--clip", "empty"}},
    {"EmptyDevice", with({"--device", ""}), {"--device", "empty"}},
    {"OneFileForTwoReports",
     with({"--stats", "/tmp/x.json", "--profile", "/tmp/./x.json"}),
     {"--profile", "--stats"}},
    {"AReportInPlaceOfThePicture",
     with({"--contact-sheet", "/tmp/lodestone-never-written.png"}),
     {"--contact-sheet", "-o"}},
    {"AReportInPlaceOfAFrame",
     {"render", "builtin:tiny", "-o", "/tmp/x.##.png", "--frames", "8-12", "--contact-sheet",
      "/tmp/x.10.png"},
     {"--contact-sheet", "-o"}},
    {"PictureInPlaceOfTheScene",
     {"render", "/tmp/map.png", "-o", "/tmp/map.png"},
     {"-o", "scene", "overwritten"}},
    {"DifferenceInPlaceOfAnImage",
     {"compare", "/tmp/a.png", "/tmp/b.png", "--diff", "/tmp/a.png"},
     {"--diff", "overwritten"}},
    {"QuietAndVerbose", with({"-q", "-v"}), {"--quiet"}},
    {"BakeToAnotherExtension", {"bake", "builtin:tiny", "-o", "tiny.bin"}, {".lode"}},
    {"FaultWithoutBit", {"parity", "builtin:tiny", "--fault", "bounds"}, {"--fault", "PASS:BIT"}},
    {"RepeatsZero", {"bench", "builtin:tiny", "--repeats", "0"}, {"--repeats"}},
    {"UnknownTraversalInList", {"bench", "builtin:tiny", "--traversal", "octant,fast"}, {"fast"}},
};

INSTANTIATE_TEST_SUITE_P(OfValues, WrongUsage, testing::ValuesIn(wrong_values),
                         [](const auto& test) { return std::string(test.param.name); });

class Resampling : public CommandLine {};

TEST_F(Resampling, IsTheDefaultOfMeshesAndTakesItsOptions) {
  write_text(place("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 4 3 2\n");
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{},
        {"--resolution", "5"},
        {"--texel-budget", "20"},
        {"--signal", "curvature"},
        {"--all-shapes"},
        {"--atlas", "auto", "--resolution", "9", "--signal", "curvature", "--all-shapes"}}) {
    std::vector<std::string> arguments = {"info", place("t.obj"), "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Result result = run(arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("\"mapped_triangles\": 2"), std::string::npos) << result.out;
  }
  const Result exact = run({"info", place("t.obj"), "--json", "--atlas", "exact"});
  EXPECT_NE(exact.out.find("\"mapped_triangles\": 0"), std::string::npos) << exact.out;
}

class Camera : public CommandLine {};

TEST_F(Camera, OfASceneWithoutOnesIsSaidNotToExist) {
  write_text(place("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_one_error(
      run({"render", place("t.obj"), "-o", place("x.png"), "--device", "cpu", "--camera", "Front"}), 2,
      {"--camera Front: the scene has no camera of its own; leave the option out, or give auto"});
}

class BadInput : public CommandLine {};

TEST_F(BadInput, AMissingSceneIsNamed) {
  expect_one_error(run({"render", place("none.obj"), "-o", place("x.png"), "--device", "cpu"}), 3,
                   {place("none.obj") + ": no such file"});
}

TEST_F(BadInput, ANameWithControlCharactersMakesOneLineAllTheSame) {
  expect_one_error(run({"render", place("a\nb\x1b[2J.obj"), "-o", place("x.png"), "--device", "cpu"}), 3,
                   {place("a?b?[2J.obj") + ": no such file"});
}

TEST_F(BadInput, ATruncatedSceneIsNamed) {
  write_text(place("cut.glb"), "glTF\2\0\0");
  expect_one_error(run({"info", place("cut.glb")}), 3, {place("cut.glb") + ": "});
}

TEST_F(BadInput, AnEmptySceneIsNamed) {
  write_text(place("empty.obj"), "");
  expect_one_error(run({"info", place("empty.obj")}), 3, {place("empty.obj") + ": "});
}

TEST_F(BadInput, ADamagedBakedFileIsNamed) {
  write_text(place("bad.lode"), "not a baked file");
  expect_one_error(run({"info", place("bad.lode")}), 3, {place("bad.lode") + ": "});
}

TEST_F(BadInput, NoFileIsLeftBehind) {
  run({"render", place("none.obj"), "-o", place("x.png"), "--device", "cpu"});
  EXPECT_TRUE(files().empty());
}

TEST(NoDevice, IsExitCodeFourAndSaysWhatThereIs) {
  const Result result =
      run({"render", "builtin:tiny", "-o", "/tmp/lodestone-never-written.png", "--device", "no-such-device"});
  expect_one_error(result, 4, {"no-such-device", "cpu, gpu and auto"});
}

}  // namespace
}  // namespace lodestone::cli
