// SPDX-License-Identifier: MIT
// Where pictures go, and what else is said.
#include <sys/stat.h>

#include <future>

#include "lodestone/image/image.h"
#include "process.h"

namespace lodestone::cli {
namespace {

using Names = std::vector<std::string>;

class Output : public CommandLine {};

TEST_F(Output, FrameNumbersFillTheRunOfMarks) {
  ASSERT_EQ(run(tiny_render(place("a.###.png"), {"--frames", "8-10"})).code, 0);
  EXPECT_EQ(files(), (Names{"a.008.png", "a.009.png", "a.010.png"}));
}

TEST_F(Output, LongNumbersKeepAllTheirDigits) {
  ASSERT_EQ(run(tiny_render(place("#.exr"), {"--frames", "123"})).code, 0);
  EXPECT_EQ(files(), (Names{"123.exr"}));
}

TEST_F(Output, OneFrameNeedsNoMark) {
  ASSERT_EQ(run(tiny_render(place("one.png"), {"--frames", "7-7"})).code, 0);
  EXPECT_EQ(files(), (Names{"one.png"}));
}

TEST_F(Output, MarksWithoutFramesAreFrameZero) {
  ASSERT_EQ(run(tiny_render(place("b##.png"))).code, 0);
  EXPECT_EQ(files(), (Names{"b00.png"}));
}

TEST_F(Output, MissingFoldersAreMade) {
  ASSERT_EQ(run(tiny_render(place("deep/er/x.png"), {"--stats", place("other/s.json")})).code, 0);
  EXPECT_TRUE(std::filesystem::exists(place("deep/er/x.png")));
  EXPECT_TRUE(std::filesystem::exists(place("other/s.json")));
}

TEST_F(Output, ExistingPicturesAreReplaced) {
  write_text(place("x.png"), "old");
  ASSERT_EQ(run(tiny_render(place("x.png"))).code, 0);
  EXPECT_EQ(read_text(place("x.png")).substr(1, 3), "PNG");
  EXPECT_EQ(files(), (Names{"x.png"}));
}

TEST_F(Output, APlaceThatCannotBeWrittenIsRefusedBeforeRendering) {
  write_text(place("file"), "");
  // So much work that the test would run out of time if it were done first.
  const std::vector<std::string> huge = {"--size", "8192x8192", "--spp", "65536"};
  for (const char* option : {"-o", "--stats", "--profile"}) {
    std::vector<std::string> arguments = {"render", "builtin:tiny", "--device", "cpu"};
    arguments.insert(arguments.end(), huge.begin(), huge.end());
    const bool picture = std::string(option) == "-o";
    arguments.insert(arguments.end(), {"-o", picture ? place("file/x.png") : place("x.png")});
    if (!picture) arguments.insert(arguments.end(), {option, place("file/x.json")});
    const Result result = run(arguments);
    EXPECT_EQ(result.code, 5) << option;
    EXPECT_EQ(result.err.rfind("lodestone: error: " + place("file/x"), 0), 0u) << result.err;
  }
  EXPECT_EQ(files(), (Names{"file"}));
}

TEST_F(Output, AFolderIsNoPlaceForAPicture) {
  std::filesystem::create_directory(place("x.png"));
  EXPECT_EQ(run(tiny_render(place("x.png"))).code, 5);
}

TEST_F(Output, ADeviceOrPipeIsWrittenIntoAndNotReplaced) {
  ASSERT_EQ(::mkfifo(place("pipe.json").c_str(), 0600), 0);
  for (const char* option : {"--stats", "--profile"}) {
    auto read = std::async(std::launch::async, [&] { return read_text(place("pipe.json")); });
    const Result result = run(tiny_render(place("x.png"), {option, place("pipe.json")}));
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(read.get().front(), '{');
  }
  EXPECT_TRUE(std::filesystem::is_fifo(place("pipe.json")));
  EXPECT_EQ(run(tiny_render(place("x.png"), {"--stats", "/dev/full"})).code, 5);
}

TEST_F(Output, ALinkStaysAndItsTargetIsWritten) {
  std::filesystem::create_symlink("real.png", place("link.png"));
  ASSERT_EQ(run(tiny_render(place("link.png"))).code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(place("link.png")));
  EXPECT_EQ(files(), (Names{"link.png", "real.png"}));
  EXPECT_EQ(image::read(place("real.png")).width, 24u);
}

TEST_F(Output, NamesInWarningsDoNothingToATerminal) {
  write_text(place("t.obj"), "usemtl \x1b[2Jnone\xc2\x9b\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  std::filesystem::rename(place("t.obj"), place("a\x1b[2J\rb.obj"));
  const Result result = run(
      {"render", place("a\x1b[2J\rb.obj"), "-o", place("x.png"), "--size", "8x8", "--device", "cpu", "-v"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("a?[2J?b.obj: 1 triangles"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find_first_of("\x1b\r"), std::string::npos);
  EXPECT_EQ(run({"info", place("a\x1b[2J\rb.obj")}).out.find_first_of("\x1b\r"), std::string::npos);
}

TEST_F(Output, AReportBesideASequenceMayLookLikeAFrame) {
  ASSERT_EQ(
      run(tiny_render(place("x.##.png"), {"--frames", "0-1", "--contact-sheet", place("x.02.png")})).code, 0);
  EXPECT_EQ(files(), (Names{"x.00.png", "x.01.png", "x.02.png"}));
}

TEST_F(Output, LargeFramesAreSmallOnTheContactSheet) {
  ASSERT_EQ(
      run(tiny_render(place("a.##.png"), {"--frames", "0-1", "--contact-sheet", place("small.png")})).code,
      0);
  EXPECT_EQ(image::read(place("small.png")).width, 4u + 2 * (24 + 4));
  const std::vector<std::string> arguments = {
      "render", "builtin:tiny", "-o",      place("b.png"),    "--device",
      "cpu",    "--size",       "1025x10", "--contact-sheet", place("large.png")};
  ASSERT_EQ(run(arguments).code, 0);
  EXPECT_EQ(image::read(place("large.png")).width, 4u + 342 + 4);  // a third of it
}

TEST_F(Output, AFullDiskBehindStandardOutputIsAnError) {
  ProcessOptions options;
  options.output = "/dev/full";
  const Result result = run({"info", "builtin:tiny"}, options);
  EXPECT_EQ(result.code, 5);
  EXPECT_EQ(result.err.rfind("lodestone: error: ", 0), 0u) << result.err;
}

TEST_F(Output, QuietSaysNothing) {
  const Result result = run(tiny_render(place("x##.png"), {"--frames", "0-2", "-q"}));
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Output, ValidatingTheCpuIsSaidToBeNothing) {
  const Result result = run(tiny_render(place("x.png"), {"--validate"}));
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err.rfind("lodestone: warning: --validate", 0), 0u) << result.err;
}

TEST_F(Output, VerboseTellsDeviceSceneAndPasses) {
  const Result result = run(tiny_render(place("x.png"), {"-v"}));
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, "");
  for (const char* part : {"CPU", "triangles", "rasterise", "wall ms", "share"})
    EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n" << result.err;
}

TEST_F(Output, ProgressCanBeReadByAMachine) {
  const Result result = run(tiny_render(place("x##.png"), {"--frames", "5-6", "--progress", "json"}));
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err.rfind("{\"frame\":1,\"frames\":2,\"seconds_left\":", 0), 0u) << result.err;
  EXPECT_NE(result.err.find("\n{\"frame\":2,\"frames\":2,\"seconds_left\":0.000}\n"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace lodestone::cli
