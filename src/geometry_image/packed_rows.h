// SPDX-License-Identifier: MIT
// Arrays of rows of 32-bit words, compressed. Neighbouring rows of an atlas mostly differ by the same small
// steps, so each block is stored column by column as differences before zstd sees it: five to a thousand
// times smaller than without. Blocks are packed and unpacked in parallel.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/geometry_image/byte_stream.h"

namespace lodestone::geometry_image {

// Writes `rows`, whose size must be a multiple of `row_bytes`, a multiple of 4.
void pack_rows(std::span<const std::byte> rows, size_t row_bytes, ByteWriter& writer);

template <class Row>
requires std::is_trivially_copyable_v<Row>
void pack_rows(const std::vector<Row>& rows, ByteWriter& writer) {
  pack_rows(std::as_bytes(std::span(rows)), sizeof(Row), writer);
}

// What pack_rows wrote, block by block.
class PackedRows {
 public:
  // Throws Error(bad_input) where the reader does not hold what `rows` rows need.
  PackedRows(ByteReader& reader, uint64_t rows, size_t row_bytes);

  uint64_t rows_per_block() const { return rows_per_block_; }
  // Unpacks the block whose first row is `first_row` (a multiple of rows_per_block()); `block` has its size.
  // False where it is damaged.
  bool unpack(uint64_t first_row, std::span<std::byte> block) const;

 private:
  std::vector<std::span<const std::byte>> blocks_;
  uint64_t rows_per_block_;
  size_t row_bytes_;
};

// `count` rows, allocated no faster than they are found to be there. Throws Error(bad_input).
template <class Row>
requires std::is_trivially_copyable_v<Row> std::vector<Row> unpack_rows(ByteReader& reader, uint64_t count) {
  constexpr uint64_t blocks_at_once = 16;
  const PackedRows packed(reader, count, sizeof(Row));
  std::vector<Row> rows;
  while (rows.size() < count) {
    const uint64_t first = rows.size();
    const uint64_t end = std::min(count, first + blocks_at_once * packed.rows_per_block());
    if (rows.capacity() < end) rows.reserve(std::min(count, std::max<uint64_t>(end, 2 * rows.capacity())));
    rows.resize(end);
    std::atomic<bool> good = true;
    parallel_for(end - first, packed.rows_per_block(), [&](uint64_t block_begin, uint64_t block_end) {
      const std::span<Row> block(&rows[first + block_begin], block_end - block_begin);
      if (!packed.unpack(first + block_begin, std::as_writable_bytes(block))) good = false;
    });
    if (!good) reader.fail("an array cannot be unpacked");
  }
  return rows;
}

}  // namespace lodestone::geometry_image
