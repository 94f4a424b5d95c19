// SPDX-License-Identifier: MIT
#include "lodestone/image/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "lodestone/base/parallel.h"
#include "lodestone/image/flip.h"

namespace lodestone::image {
namespace {

struct Pair {
  const Channel* a;
  const Channel* b;
  bool ids() const { return !a->ids.empty(); }
};

bool equal(float a, float b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

// Sums over a range of pixels of one channel.
struct ChannelSums {
  double max = 0, sum = 0, squares = 0;
  uint64_t non_finite = 0, different = 0;
};

struct Sums {
  std::vector<ChannelSums> channels;
  uint64_t pixels_over = 0;
  // The first difference in reading order.
  size_t first_pixel = std::numeric_limits<size_t>::max();
  size_t first_channel = 0;
};

void note_difference(Sums& sums, size_t channel, size_t pixel) {
  ++sums.channels[channel].different;
  if (pixel >= sums.first_pixel) return;
  sums.first_pixel = pixel;
  sums.first_channel = channel;
}

// Adds one sample; returns whether it is over the threshold of a pixel.
bool add_sample(const Pair& pair, size_t channel, size_t pixel, double threshold, Sums& sums) {
  if (pair.ids()) {
    if (pair.a->ids[pixel] == pair.b->ids[pixel]) return false;
    note_difference(sums, channel, pixel);
    return true;
  }
  const float a = pair.a->values[pixel], b = pair.b->values[pixel];
  if (equal(a, b)) return false;
  note_difference(sums, channel, pixel);
  ChannelSums& into = sums.channels[channel];
  if (!std::isfinite(a) || !std::isfinite(b)) {
    ++into.non_finite;
    return true;
  }
  const double difference = std::abs(double(a) - double(b));
  into.max = std::max(into.max, difference);
  into.sum += difference;
  into.squares += difference * difference;
  return difference > threshold;
}

Sums add_range(const std::vector<Pair>& pairs, size_t begin, size_t end, double threshold) {
  Sums sums;
  sums.channels.resize(pairs.size());
  for (size_t pixel = begin; pixel < end; ++pixel) {
    bool over = false;
    for (size_t channel = 0; channel < pairs.size(); ++channel)
      over |= add_sample(pairs[channel], channel, pixel, threshold, sums);
    sums.pixels_over += over ? 1 : 0;
  }
  return sums;
}

// Adds the sums of a range to those of the ranges before it.
void append(Sums& sums, const Sums& next) {
  sums.channels.resize(next.channels.size());
  for (size_t c = 0; c < next.channels.size(); ++c) {
    ChannelSums& into = sums.channels[c];
    const ChannelSums& from = next.channels[c];
    into.max = std::max(into.max, from.max);
    into.sum += from.sum;
    into.squares += from.squares;
    into.non_finite += from.non_finite;
    into.different += from.different;
  }
  sums.pixels_over += next.pixels_over;
  if (next.first_pixel >= sums.first_pixel) return;
  sums.first_pixel = next.first_pixel;
  sums.first_channel = next.first_channel;
}

// Ranges are fixed and added up in their order, so that sums do not hang on the threads.
Sums add_all(const std::vector<Pair>& pairs, size_t pixels, double threshold) {
  constexpr size_t range = size_t(1) << 16;
  std::vector<Sums> partial((pixels + range - 1) / range);
  parallel_for(pixels, range, [&](uint64_t begin, uint64_t end) {
    partial[begin / range] = add_range(pairs, begin, end, threshold);
  });
  Sums total;
  for (const Sums& sums : partial) append(total, sums);
  return total;
}

bool is_ignored(const std::string& name, const Thresholds& thresholds) {
  return std::any_of(thresholds.ignore.begin(), thresholds.ignore.end(), [&](const std::string& ignored) {
    return name == ignored || name.starts_with(ignored + '.');
  });
}

// The channels to compare; sets same_channels and first_difference where the images do not hold the same.
std::vector<Pair> match_channels(const Image& a, const Image& b, const Thresholds& thresholds,
                                 Comparison& result) {
  std::vector<Pair> pairs;
  const auto differ = [&](std::string difference) {
    if (result.same_channels) result.first_difference = std::move(difference);
    result.same_channels = false;
  };
  for (const Channel& channel : a.channels) {
    if (is_ignored(channel.name, thresholds)) continue;
    const Channel* other = b.find(channel.name);
    if (other == nullptr)
      differ(fmt::format("channel {} is in the first image only", channel.name));
    else if (channel.ids.empty() != other->ids.empty())
      differ(fmt::format("channel {} holds floats in one image and ids in the other", channel.name));
    else
      pairs.push_back({&channel, other});
  }
  for (const Channel& channel : b.channels) {
    if (!is_ignored(channel.name, thresholds) && a.find(channel.name) == nullptr)
      differ(fmt::format("channel {} is in the second image only", channel.name));
  }
  return pairs;
}

std::string describe(const Pair& pair, size_t pixel, uint32_t width) {
  const std::string where =
      fmt::format("pixel ({}, {}), channel {}", pixel % width, pixel / width, pair.a->name);
  if (pair.ids()) return fmt::format("{}: {} and {}", where, pair.a->ids[pixel], pair.b->ids[pixel]);
  return fmt::format("{}: {} and {}", where, pair.a->values[pixel], pair.b->values[pixel]);
}

void measure(const std::vector<Pair>& pairs, uint32_t width, size_t pixels, double threshold,
             Comparison& result) {
  const Sums sums = add_all(pairs, pixels, threshold);
  double means = 0, squares = 0;
  size_t floats = 0;
  for (size_t c = 0; c < pairs.size(); ++c) {
    const ChannelSums& from = sums.channels[c];
    ChannelDifference& into = result.channels.emplace_back();
    into.name = pairs[c].a->name;
    into.ids = pairs[c].ids();
    into.non_finite = from.non_finite;
    into.different = from.different;
    if (into.ids) continue;
    const double apart = from.non_finite == 0 ? 0 : std::numeric_limits<double>::infinity();
    into.max = from.max + apart;
    into.mean = from.sum / double(pixels) + apart;
    into.rmse = std::sqrt(from.squares / double(pixels)) + apart;
    result.max = std::max(result.max, into.max);
    means += into.mean;
    squares += from.squares / double(pixels) + apart;
    ++floats;
  }
  if (floats > 0) {
    result.mean = means / double(floats);
    result.rmse = std::sqrt(squares / double(floats));
  }
  result.pixel_share = double(sums.pixels_over) / double(pixels);
  if (sums.first_pixel < pixels)
    result.first_difference = describe(pairs[sums.first_channel], sums.first_pixel, width);
}

void measure_flip(const Image& a, const Image& b, Comparison& result) {
  uint64_t colours = 0, different = 0;
  for (const ChannelDifference& channel : result.channels) {
    if (channel.ids || (channel.name != "R" && channel.name != "G" && channel.name != "B")) continue;
    if (channel.non_finite > 0) return;
    ++colours;
    different += channel.different;
  }
  if (colours < 3) return;
  // Equal samples that mean different light look different.
  const bool same = different == 0 && a.linear == b.linear;
  const FlipSummary flip = same ? FlipSummary() : summarise(flip_error(a, b));
  result.flip_mean = flip.mean;
  result.flip_p99 = flip.p99;
}

// Judges a comparison; `failures` gets a line for every threshold broken.
class Judge {
 public:
  Judge(const Thresholds& thresholds, Comparison& result) : thresholds_(thresholds), result_(result) {
    for (const ChannelDifference& channel : result.channels) {
      different_ += channel.different;
      if (channel.ids) ids_ += channel.different;
      non_finite_ += channel.non_finite;
    }
  }

  void judge() {
    const bool pixel_rule = thresholds_.pixel > 0 || thresholds_.pixel_share > 0;
    const bool any = pixel_rule || thresholds_.max || thresholds_.mean || thresholds_.rmse ||
                     thresholds_.flip_mean || thresholds_.flip_p99;
    if (!any) {
      if (different_ > 0) fail("{} samples differ, and no threshold allows any", different_);
      return;
    }
    bound("max", thresholds_.max, result_.max);
    bound("mean", thresholds_.mean, result_.mean);
    bound("rmse", thresholds_.rmse, result_.rmse);
    bound("FLIP mean", thresholds_.flip_mean, result_.flip_mean);
    bound("FLIP 99th percentile", thresholds_.flip_p99, result_.flip_p99);
    if (pixel_rule) {
      if (!(result_.pixel_share <= thresholds_.pixel_share))
        fail("{:.6g} of the pixels differ by more than {:.6g}; {:.6g} may", result_.pixel_share,
             thresholds_.pixel, thresholds_.pixel_share);
      return;
    }
    if (non_finite_ > 0)
      fail("{} samples are NaN or infinite in one image and not the same in the other", non_finite_);
    if (ids_ > 0) fail("{} ids differ", ids_);
  }

 private:
  template <class... Args>
  void fail(fmt::format_string<Args...> format, Args&&... args) {
    result_.failures.push_back(fmt::format(format, std::forward<Args>(args)...));
  }

  void bound(std::string_view name, std::optional<double> limit, std::optional<double> measured) {
    if (!limit) return;
    if (!measured)
      fail("{} cannot be measured: it takes R G B in both images, finite where they differ", name);
    else if (!(*measured <= *limit))
      fail("{} is {:.6g}, above {:.6g}", name, *measured, *limit);
  }

  const Thresholds& thresholds_;
  Comparison& result_;
  uint64_t different_ = 0, ids_ = 0, non_finite_ = 0;
};

}  // namespace

Comparison compare(const Image& a, const Image& b, const Thresholds& thresholds) {
  Comparison result;
  result.same_size = a.width == b.width && a.height == b.height;
  const std::vector<Pair> pairs = match_channels(a, b, thresholds, result);
  if (!result.same_size)
    result.first_difference =
        fmt::format("size: {} x {} pixels and {} x {} pixels", a.width, a.height, b.width, b.height);
  if (!result.same_size || !result.same_channels) {
    result.failures.push_back(result.first_difference);
    return result;
  }
  if (pairs.empty()) {  // a check that checks nothing must not pass
    result.failures.emplace_back("no channel is left to compare");
    return result;
  }
  if (a.pixels() > 0) {
    measure(pairs, a.width, a.pixels(), thresholds.pixel, result);
    measure_flip(a, b, result);
  }
  Judge(thresholds, result).judge();
  result.pass = result.failures.empty();
  return result;
}

}  // namespace lodestone::image
