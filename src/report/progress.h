// SPDX-License-Identifier: MIT
// How far a sequence of frames has come, on standard error.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

namespace lodestone::report {

enum class ProgressMode {
  automatic,  // a line that is redrawn on a terminal, a plain line now and then elsewhere
  off,
  json  // {"frame":DONE,"frames":ALL,"seconds_left":S}, one line a finished frame
};

// Not thread-safe.
class Progress {
 public:
  struct Output {
    std::function<void(const std::string&)> write;  // default: standard error
    bool terminal = false;
    std::function<double()> seconds;  // a steady clock
  };
  static Output standard_error();

  Progress(ProgressMode mode, uint32_t frames, Output output = standard_error());
  ~Progress();  // clears the redrawn line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void frame_done();
  // Redraws the line of a terminal; may be called often.
  void tick();
  // Clears the redrawn line, so that something else can be printed in its place.
  void clear();

 private:
  std::optional<double> seconds_left() const;
  std::string line() const;
  void redraw();

  ProgressMode mode_;
  uint32_t frames_, done_ = 0;
  Output output_;
  double begin_, last_done_, last_print_;
  size_t drawn_ = 0;  // characters of the line that stands on the terminal
};

// 75 as `1:15`, 3675 as `1:01:15`.
std::string duration_text(double seconds);

}  // namespace lodestone::report
