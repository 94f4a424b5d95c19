// SPDX-License-Identifier: MIT
// Ctrl-C keeps what is finished.
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
    options.signal_when = [this] { return std::filesystem::exists(place("x.00002.png")); };
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

TEST_F(Interrupt, StopsAFrameThatIsInProgress) {
  ProcessOptions options;
  options.signal = SIGINT;
  const auto begin = std::chrono::steady_clock::now();
  options.signal_when = [begin] {
    return std::chrono::steady_clock::now() - begin > std::chrono::seconds(5);
  };
  const Result result = run({"render", "builtin:tiny", "-o", place("x.png"), "--device", "cpu", "--size",
                             "4096x4096", "--spp", "65536"},
                            options);
  EXPECT_EQ(result.code, 130);
  EXPECT_LT(result.seconds_after_signal, 10) << "the rest of the frame would take hours";
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace lodestone::cli
