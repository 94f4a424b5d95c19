// SPDX-License-Identifier: MIT
#include "lodestone/base/nearest_name.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace lodestone {
namespace {

// A name can be as long as a file.
constexpr size_t longest_compared = 100;

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

// How many letters must change, come or go to make one word of the other.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t(0));
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view name, std::span<const std::string> names) {
  if (name.size() > longest_compared) return {};
  const std::string wanted = lower_case(name);
  std::optional<std::string> nearest;
  size_t least = 0;
  for (const std::string& known : names) {
    if (known.size() > longest_compared) continue;
    const size_t distance = edit_distance(wanted, lower_case(known));
    if (distance > std::max(known.size() / 3, size_t(1)) || (nearest && distance >= least)) continue;
    nearest = known;
    least = distance;
  }
  return nearest;
}

}  // namespace lodestone
