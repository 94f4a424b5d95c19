// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/packed_rows.h"

#include <zstd.h>

#include <new>

namespace lodestone::geometry_image {
namespace {

constexpr uint64_t block_bytes = 1u << 20;
constexpr int compression_level = 3;

uint64_t rows_in_block(size_t row_bytes) {
  return block_bytes / row_bytes;
}

// Word c of row r is put behind all words of the columns before c, as its difference to that of row r - 1.
void to_columns(std::span<const std::byte> rows, size_t row_bytes, std::byte* columns) {
  const size_t count = rows.size() / row_bytes;
  for (size_t at = 0; at < row_bytes; at += 4) {
    uint32_t before = 0;
    for (size_t r = 0; r < count; ++r, columns += 4) {
      uint32_t word;
      std::memcpy(&word, &rows[r * row_bytes + at], 4);
      const uint32_t difference = word - before;
      std::memcpy(columns, &difference, 4);
      before = word;
    }
  }
}

void to_rows(const std::byte* columns, size_t row_bytes, std::span<std::byte> rows) {
  const size_t count = rows.size() / row_bytes;
  for (size_t at = 0; at < row_bytes; at += 4) {
    uint32_t word = 0;
    for (size_t r = 0; r < count; ++r, columns += 4) {
      uint32_t difference;
      std::memcpy(&difference, columns, 4);
      word += difference;
      std::memcpy(&rows[r * row_bytes + at], &word, 4);
    }
  }
}

std::vector<std::byte> compressed(std::span<const std::byte> bytes) {
  std::vector<std::byte> packed(ZSTD_compressBound(bytes.size()));
  const size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), compression_level);
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // with enough room its only failure
  packed.resize(size);
  packed.shrink_to_fit();
  return packed;
}

}  // namespace

void pack_rows(std::span<const std::byte> rows, size_t row_bytes, ByteWriter& writer) {
  const uint64_t full = rows_in_block(row_bytes) * row_bytes;
  std::vector<std::vector<std::byte>> blocks((rows.size() + full - 1) / full);
  parallel_for(rows.size(), full, [&](uint64_t begin, uint64_t end) {
    std::vector<std::byte> columns(end - begin);
    to_columns(rows.subspan(begin, end - begin), row_bytes, columns.data());
    blocks[begin / full] = compressed(columns);
  });
  for (const std::vector<std::byte>& block : blocks) writer.number(static_cast<uint32_t>(block.size()));
  for (const std::vector<std::byte>& block : blocks) writer.bytes(block);
}

PackedRows::PackedRows(ByteReader& reader, uint64_t rows, size_t row_bytes)
    : rows_per_block_(rows_in_block(row_bytes)), row_bytes_(row_bytes) {
  std::vector<uint32_t> sizes;
  for (uint64_t first = 0; first < rows; first += rows_per_block_) sizes.push_back(reader.number<uint32_t>());
  for (const uint32_t size : sizes) blocks_.push_back(reader.bytes(size));
}

bool PackedRows::unpack(uint64_t first_row, std::span<std::byte> block) const {
  const std::span<const std::byte> packed = blocks_[first_row / rows_per_block_];
  std::vector<std::byte> columns(block.size());
  if (ZSTD_decompress(columns.data(), columns.size(), packed.data(), packed.size()) != block.size())
    return false;
  to_rows(columns.data(), row_bytes_, block);
  return true;
}

}  // namespace lodestone::geometry_image
