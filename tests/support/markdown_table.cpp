// SPDX-License-Identifier: MIT
#include "lodestone/test_support/markdown_table.h"

#include <fmt/format.h>

#include <stdexcept>

namespace lodestone::test {

std::string markdown_table(const TableRow& head, const std::vector<TableRow>& rows) {
  const auto line = [&](const TableRow& cells) {
    if (cells.size() != head.size())
      throw std::invalid_argument(fmt::format("a row of {} cells under {}", cells.size(), head.size()));
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
  };
  TableRow rule(head.size(), "---:");
  if (!rule.empty()) rule.front() = "---";
  std::string text = line(head) + line(rule);
  for (const TableRow& row : rows) text += line(row);
  return text;
}

}  // namespace lodestone::test
