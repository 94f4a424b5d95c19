// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_attempts.h"

#include <algorithm>
#include <utility>

#include "lodestone/geometry_image/texel_values.h"

namespace lodestone::geometry_image {
namespace {

// Attempts end when so many have brought nothing better, or after so many in all; after a few where what is
// still too far is to be split.
constexpr uint32_t patience = 10, most_attempts = 16, few_attempts = 3;
// Where more than one in so many cells is too far, the budget is to blame and not the cells.
constexpr size_t few_of_all = 4;
constexpr double apart = 2;  // in tolerances, the points that are measured
// Cells of fewer faces are not split for an uneven map, that is, one whose stretch has a larger root mean
// square, as where a limb was to be flattened; nor for being too far.
constexpr size_t worth_splitting = 32;
constexpr double too_uneven = 2.5;

}  // namespace

ChartAttempts::ChartAttempts(std::unique_ptr<const base_complex::BaseComplex> complex,
                             const ChartSource& source, std::vector<ChartProfile> profiles, Need need,
                             const Target& target, const OnStage& on_stage)
    : complex_(std::move(complex)),
      target_(target),
      on_stage_(on_stage),
      profiles_(std::move(profiles)),
      arc_errors_(*complex_),
      feedback_(*complex_, arc_errors_, target.tolerance, std::move(need)),
      charts_(source),
      errors_(*complex_, target_.surface, target.tree, apart * target.tolerance) {}

void ChartAttempts::stage(const char* name) const {
  if (on_stage_) on_stage_(name);
}

ChartAttempts::Outcome ChartAttempts::run(const Limits& limits) {
  const auto worth = [&](std::vector<uint32_t> cells) {
    std::erase_if(cells, [&](uint32_t c) { return complex_->cells[c].faces.size() <= worth_splitting; });
    return cells;
  };
  uint32_t best_attempt = 0;
  for (uint32_t attempt = 0; attempt < std::min(best_attempt + patience, most_attempts); ++attempt) {
    stage("sizes");
    const std::vector<ChartSize> sizes =
        choose_sizes(*complex_, profiles_, arc_errors_, feedback_.need(), target_.texel_budget);
    stage("maps");
    std::vector<uint32_t> failed = charts_.resize(sizes);
    if (!failed.empty()) return {Fault::unmappable, std::move(failed)};
    if (limits.even) {
      std::vector<uint32_t> list = worth(uneven());
      if (!list.empty()) return {Fault::uneven, std::move(list)};
    }
    stage("errors");
    const std::vector<double> errors = measure();
    const double bad = feedback_.badness(errors);
    if (!exist() || bad < badness_) {
      badness_ = bad;
      best_attempt = attempt;
      best_sizes_ = sizes;
    }
    const bool learnt = feedback_.learn(sizes, errors);
    if (limits.near && (!learnt || attempt + 1 >= few_attempts)) {
      std::vector<uint32_t> list = worth(feedback_.always_far(errors));
      if (!list.empty() && few_of_all * list.size() <= errors.size()) return {Fault::far, std::move(list)};
    }
    if (!learnt) break;
  }
  return {};
}

std::vector<uint32_t> ChartAttempts::uneven() const {
  std::vector<uint32_t> list;
  for (uint32_t c = 0; c < complex_->cells.size(); ++c)
    if (charts_.stretch(c).unevenness > too_uneven) list.push_back(c);
  return list;
}

std::vector<double> ChartAttempts::measure() {
  const std::vector<glm::vec3> points =
      at_texels(charts_.source().assembly, charts_.texels(), target_.positions);
  return errors_.measure({charts_.records(), points}, charts_.changed());
}

MappedCharts ChartAttempts::finish() {
  constexpr double enough = 0.25;  // in tolerances, so near is always near enough
  stage("unfold");
  charts_.resize(best_sizes_);
  const std::vector<double> folded = measure();
  charts_.unfold();
  const std::vector<double> unfolded = measure();
  std::vector<bool> worse(folded.size());
  for (size_t c = 0; c < worse.size(); ++c)
    worse[c] = charts_.changed()[c] && unfolded[c] > std::max(folded[c], enough * target_.tolerance);
  charts_.fold_again(worse);
  return charts_.result();
}

}  // namespace lodestone::geometry_image
