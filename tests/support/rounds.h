// SPDX-License-Identifier: MIT
// Contenders that take turns (A B A B ...), so that whatever else the machine does meets all of them; what
// counts is the median of the ratios, round by round.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace lodestone::test {

// What `work` takes by the clock.
double seconds(const std::function<void()>& work);

// "2.44 (2.16 to 2.47)": the median and the range; of at least one value.
std::string spread(const std::vector<double>& values);

// Seconds of two contenders, one of each a round.
struct Rounds {
  std::vector<double> theirs, ours, ratio;  // theirs / ours: how many times as fast ours are
  void add(double theirs_s, double ours_s);
};

}  // namespace lodestone::test
