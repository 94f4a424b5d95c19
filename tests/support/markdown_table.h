// SPDX-License-Identifier: MIT
// Tables of Markdown, for documents that benches write parts of.
#pragma once

#include <string>
#include <vector>

namespace lodestone::test {

using TableRow = std::vector<std::string>;

// The first column to the left, all others to the right. Throws std::invalid_argument where a row has not as
// many cells as the head.
std::string markdown_table(const TableRow& head, const std::vector<TableRow>& rows);

}  // namespace lodestone::test
