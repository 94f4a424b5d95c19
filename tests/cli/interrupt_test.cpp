// SPDX-License-Identifier: MIT
// Ctrl-C keeps what is finished, and nothing else.
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "lodestone/image/image.h"
#include "process.h"

namespace lodestone::cli {
namespace {

class Interrupt : public CommandLine {
 protected:
  // A sequence that would take hours, stopped once its third frame is on disk.
  Result interrupt(int signal, const std::vector<std::string>& more = {}) const {
    ProcessOptions options;
    options.signal = signal;
    options.signal_when = [this](const Result&) { return std::filesystem::exists(place("x.00002.png")); };
    std::vector<std::string> arguments = {"--frames", "0-99999"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(tiny_render(place("x.#####.png"), arguments), options);
  }
};

TEST_F(Interrupt, KeepsFinishedFramesAndTheirStatistics) {
  const Result result = interrupt(SIGINT, {"--stats", place("s.json")});
  EXPECT_EQ(result.code, 130);
  const auto json = nlohmann::json::parse(read_text(place("s.json")));
  const size_t frames = json["frames"].size();
  EXPECT_GE(frames, 3u);
  EXPECT_EQ(files().size(), frames + 1);  // every frame, the statistics, and nothing half written
  for (size_t frame = 0; frame < frames; ++frame) {
    char name[32];
    std::snprintf(name, sizeof name, "x.%05zu.png", frame);
    EXPECT_EQ(image::read(place(name)).width, 24u) << name;
  }
}

TEST_F(Interrupt, TerminationIsTheSame) {
  EXPECT_EQ(interrupt(SIGTERM).code, 130);
}

TEST_F(Interrupt, SaysHowFarItCameUnlessQuiet) {
  EXPECT_NE(interrupt(SIGINT).err.find("of 100000 frames"), std::string::npos);
}

TEST_F(Interrupt, QuietSaysNothing) {
  EXPECT_EQ(interrupt(SIGINT, {"-q"}).err, "");
}

// With --progressive there is a picture as soon as every pixel has a sample, and it gets better.
TEST_F(Interrupt, KeepsTheSamplesThatAPictureHas) {
  std::string first;
  ProcessOptions options;
  options.signal = SIGINT;
  options.signal_when = [&](const Result&) {
    if (!std::filesystem::exists(place("x.exr"))) return false;
    const auto spp = image::read(place("x.exr")).metadata.at("lodestone:spp");
    if (first.empty()) first = spp;
    return std::stoul(spp) >= 64 && spp != first;
  };
  const Result result = run(tiny_render(place("x.exr"), {"--spp", "65536", "--progressive"}), options);
  EXPECT_EQ(result.code, 130);
  EXPECT_NE(result.err.find("of 65536 samples"), std::string::npos) << result.err;
  const image::Image picture = image::read(place("x.exr"));
  const unsigned long spp = std::stoul(picture.metadata.at("lodestone:spp"));
  EXPECT_GE(spp, 64u);
  EXPECT_LT(spp, 65536u);
  // Near the mean that 4096 samples give: no batch is in the middle of a sample.
  ASSERT_EQ(run(tiny_render(place("y.exr"), {"--spp", "4096"})).code, 0);
  const image::Image expected = image::read(place("y.exr"));
  for (const char* channel : {"R", "G", "B"}) {
    double found = 0, wanted = 0;
    for (const float value : picture.find(channel)->values) found += value;
    for (const float value : expected.find(channel)->values) wanted += value;
    EXPECT_NEAR(found, wanted, 0.02 * wanted) << channel;
  }
}

TEST_F(Interrupt, StopsAFrameThatIsInProgress) {
  ProcessOptions options;
  options.signal = SIGINT;
  const auto begin = std::chrono::steady_clock::now();
  options.signal_when = [begin](const Result&) {
    return std::chrono::steady_clock::now() - begin > std::chrono::seconds(5);
  };
  const Result result = run({"render", "builtin:tiny", "-o", place("x.png"), "--device", "cpu", "--size",
                             "4096x4096", "--spp", "65536"},
                            options);
  EXPECT_EQ(result.code, 130);
  EXPECT_LT(result.seconds_after_signal, 10) << "the rest of the frame would take hours";
  EXPECT_TRUE(files().empty());
}

class InterruptedBake : public CommandLine {
 protected:
  // A ball of 60,000 triangles as an .obj, which is no grid to the program.
  std::string ball() const {
    constexpr int rows = 150, columns = 200;
    constexpr double pi = 3.14159265358979;
    std::string text;
    char line[96];
    for (int y = 0; y <= rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const double theta = pi * (y + 0.5) / (rows + 1), phi = 2 * pi * x / columns;
        std::snprintf(line, sizeof line, "v %.6f %.6f %.6f\n", std::sin(theta) * std::cos(phi),
                      std::cos(theta), std::sin(theta) * std::sin(phi));
        text += line;
      }
    }
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const int a = y * columns + x + 1, b = y * columns + (x + 1) % columns + 1;
        std::snprintf(line, sizeof line, "f %d %d %d %d\n", a, b, b + columns, a + columns);
        text += line;
      }
    }
    write_text(place("ball.obj"), text);
    return place("ball.obj");
  }
  // On a terminal, which shows the stages; interrupted when it shows this one.
  Result stop(const std::vector<std::string>& arguments, const std::string& stage,
              int signal = SIGINT) const {
    ProcessOptions options = {.environment = {{"LODESTONE_CACHE", place("cache")}}};
    options.terminal = true;
    options.signal = signal;
    options.signal_when = [stage](const Result& so_far) {
      return so_far.err.find("ball.obj: " + stage + " ...") != std::string::npos;
    };
    Result result = run(arguments, options);
    EXPECT_EQ(result.code, 130) << stage << ": " << result.err;
    EXPECT_LT(result.seconds_after_signal, 2) << stage;
    return result;
  }
  Result finish(const std::vector<std::string>& arguments) const {
    Result result = run(arguments, {.environment = {{"LODESTONE_CACHE", place("cache")}}});
    EXPECT_EQ(result.code, 0) << result.err;
    return result;
  }
};

TEST_F(InterruptedBake, LeavesNoFileAndTheNextOneWorks) {
  const std::vector<std::string> bake = {"bake", ball(), "-o", place("ball.lode")};
  for (const char* stage : {"survey", "cells", "maps", "errors", "distance"}) {
    stop(bake, stage);
    EXPECT_EQ(files(), std::vector<std::string>{"ball.obj"}) << stage;
  }
  stop(bake, "maps", SIGTERM);
  EXPECT_EQ(files(), std::vector<std::string>{"ball.obj"});
  EXPECT_NE(finish(bake).out.find("resampled        60000 triangles"), std::string::npos);
  EXPECT_EQ(files(), (std::vector<std::string>{"ball.lode", "ball.obj"}));
  EXPECT_EQ(run({"info", place("ball.lode")}).code, 0);
}

TEST_F(InterruptedBake, LeavesNothingInTheCacheAndTheNextPictureIsMade) {
  const std::vector<std::string> render = {"render",   ball(), "-o", place("x.png"), "--size", "16x16",
                                           "--device", "cpu",  "-v"};
  for (const char* stage : {"seams", "maps", "errors"}) {
    stop(render, stage);
    EXPECT_EQ(files(), std::vector<std::string>{"ball.obj"}) << stage;  // and no folder for the cache
  }
  EXPECT_EQ(finish(render).err.find("atlas from the cache"), std::string::npos);
  EXPECT_EQ(files(), (std::vector<std::string>{"ball.obj", "cache", "x.png"}));
  EXPECT_NE(finish(render).err.find("atlas from the cache"), std::string::npos);
}

TEST_F(InterruptedBake, ShowsItsStagesOnATerminalAlone) {
  const std::vector<std::string> info = {"info", ball()};
  const Result shown = run(info, {.environment = {{"LODESTONE_CACHE", place("a")}}, .terminal = true});
  for (const char* stage : {"survey", "seams", "cells", "complex", "maps", "errors", "order"})
    EXPECT_NE(shown.err.find(std::string("ball.obj: ") + stage + " ..."), std::string::npos) << stage;
  EXPECT_EQ(run(info, {.environment = {{"LODESTONE_CACHE", place("b")}}}).err, "");
  for (const char* mode : {"off", "json"}) {
    const std::vector<std::string> render = {"render", place("ball.obj"), "-o",  place("x.png"), "--size",
                                             "16x16",  "--device",        "cpu", "--progress",   mode};
    const std::string cache = place(std::string("cache-") + mode);
    const Result result = run(render, {.environment = {{"LODESTONE_CACHE", cache}}, .terminal = true});
    EXPECT_EQ(result.err.find("maps"), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace lodestone::cli
