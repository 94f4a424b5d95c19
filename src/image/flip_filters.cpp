// SPDX-License-Identifier: MIT
// Section and table numbers: Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images".
#include "lodestone/image/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lodestone::image {
namespace {

constexpr double pi = std::numbers::pi;

// Table 1: a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct Gaussian {
  double a, b;
};
constexpr Gaussian achromatic[] = {{1, 0.0047}};
constexpr Gaussian red_green[] = {{1, 0.0053}};
constexpr Gaussian blue_yellow[] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr double widest = 0.04;            // the largest b
constexpr double feature_degrees = 0.082;  // section 4.2: width of the features that are detected

template <class Function>
std::vector<double> tabulate(int radius, Function function) {
  std::vector<double> values;
  for (int i = -radius; i <= radius; ++i) values.push_back(function(double(i)));
  return values;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

Kernel scaled(const std::vector<double>& values, double positive, double negative) {
  Kernel kernel;
  for (const double value : values)
    kernel.weights.push_back(float(value * (value > 0 ? positive : negative)));
  return kernel;
}

// Each term's kernel sums to 1; the weights hold the shares of the Gaussians in the sum over the plane.
template <size_t count>
std::vector<SeparableTerm> sensitivity(const Gaussian (&gaussians)[count], int radius,
                                       double pixels_per_degree) {
  std::vector<SeparableTerm> terms;
  std::vector<double> shares;
  for (const Gaussian& gaussian : gaussians) {
    const std::vector<double> values = tabulate(radius, [&](double pixels) {
      const double degrees = pixels / pixels_per_degree;
      return std::exp(-pi * pi * degrees * degrees / gaussian.b);
    });
    const double total = sum(values);
    shares.push_back(gaussian.a * std::sqrt(pi / gaussian.b) * total * total);
    terms.push_back({1, scaled(values, 1 / total, 1 / total)});
  }
  for (size_t i = 0; i < count; ++i) terms[i].weight = float(shares[i] / sum(shares));
  return terms;
}

// Positive and negative weights normalised apart, so that a kernel answers +-1 to the feature it looks for.
Kernel balanced(const std::vector<double>& values) {
  double positive = 0, negative = 0;
  for (const double value : values) (value > 0 ? positive : negative) += std::abs(value);
  return scaled(values, 1 / positive, 1 / negative);
}

}  // namespace

FlipFilters make_flip_filters(double pixels_per_degree) {
  FlipFilters filters;
  // Three standard deviations of the widest Gaussian: exp(-pi^2 x^2 / b) has variance b / (2 pi^2).
  const int seen = int(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
  filters.sensitivity[0] = sensitivity(achromatic, seen, pixels_per_degree);
  filters.sensitivity[1] = sensitivity(red_green, seen, pixels_per_degree);
  filters.sensitivity[2] = sensitivity(blue_yellow, seen, pixels_per_degree);

  const double deviation = 0.5 * feature_degrees * pixels_per_degree;
  const int detected = int(std::ceil(3 * deviation));
  const auto gauss = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  const std::vector<double> blur = tabulate(detected, gauss);
  filters.blur = scaled(blur, 1 / sum(blur), 1);
  filters.edge = balanced(tabulate(detected, [&](double x) { return -x * gauss(x); }));
  filters.point = balanced(
      tabulate(detected, [&](double x) { return (x * x / (deviation * deviation) - 1) * gauss(x); }));
  filters.radius = std::max(seen, detected);
  return filters;
}

}  // namespace lodestone::image
