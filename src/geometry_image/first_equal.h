// SPDX-License-Identifier: MIT
// Which of many items are equal: the one tool behind welded vertices, duplicate triangles and shared edges.
//
// A radix step deals the items out to buckets by the top bits of their hashes; then each bucket has a hash
// table of its own, small enough for a cache, and the buckets are done in parallel. Items keep their order
// within a bucket, so the result depends neither on the number of threads nor on the hash.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>
#include <vector>

#include "lodestone/base/parallel.h"

namespace lodestone::geometry_image {

// Hashes of short runs of words. The start is drawn anew in every process, so that no file can be made whose
// items all collide.
class WordHash {
 public:
  WordHash() : state_(seed()) {}
  void add(uint64_t word) {
    state_ = (state_ ^ word) * 0xd6e8feb86659fd93u;
    state_ ^= state_ >> 32;
  }
  void add(float value) { add(uint64_t(std::bit_cast<uint32_t>(value + 0.0f))); }  // -0 as +0
  uint32_t value() const { return static_cast<uint32_t>((state_ * 0x9fb21c651e98df25u) >> 32); }

 private:
  static uint64_t seed() {
    static const uint64_t value = (uint64_t(std::random_device{}()) << 32) | std::random_device{}();
    return value;
  }
  uint64_t state_;
};

namespace detail {

struct Buckets {
  std::vector<uint32_t> items;  // by bucket, ascending within one
  std::vector<uint32_t> first;  // bucket b has items [first[b], first[b + 1])
};

// Deals the items out by the top `bucket_bits` (at least 1) of their hashes.
inline Buckets deal_out(const std::vector<uint32_t>& hashes, uint32_t bucket_bits) {
  constexpr uint32_t block = 1u << 16;
  const auto count = static_cast<uint32_t>(hashes.size());
  const uint32_t blocks = count / block + 1;
  const size_t buckets = size_t(1) << bucket_bits;
  std::vector<uint32_t> places(blocks * buckets, 0);
  const auto for_each_item = [&](const auto& body) {
    parallel_for(count, block, [&](uint64_t begin, uint64_t end) {
      uint32_t* const places_of_block = &places[begin / block * buckets];
      for (auto item = static_cast<uint32_t>(begin); item < end; ++item) {
        body(item, places_of_block[hashes[item] >> (32 - bucket_bits)]);
      }
    });
  };

  // Count the items of each block and bucket, turn the counts into places, then put every item into its
  // place.
  for_each_item([](uint32_t, uint32_t& place) { ++place; });
  Buckets dealt;
  dealt.first.resize(buckets + 1, count);
  uint32_t next = 0;
  for (size_t bucket = 0; bucket < buckets; ++bucket) {
    dealt.first[bucket] = next;
    for (uint32_t b = 0; b < blocks; ++b) {
      const uint32_t here = places[b * buckets + bucket];
      places[b * buckets + bucket] = next;
      next += here;
    }
  }
  dealt.items.resize(count);
  for_each_item([&](uint32_t item, uint32_t& place) { dealt.items[place++] = item; });
  return dealt;
}

}  // namespace detail

// For each item of [0, count) the lowest item that equals it (itself, where there is none lower).
// hash(i) gives 32 bits, equal ones for equal items; equal(i, j) must be an equivalence. Both are called in
// parallel.
template <class Hash, class Equal>
std::vector<uint32_t> first_equal(uint32_t count, const Hash& hash, const Equal& equal) {
  constexpr uint32_t items_per_bucket = 1u << 14;
  const auto bucket_bits = std::clamp<uint32_t>(uint32_t(std::bit_width(count / items_per_bucket)), 1, 10);
  std::vector<uint32_t> hashes(count);
  parallel_for(count, items_per_bucket, [&](uint64_t begin, uint64_t end) {
    for (auto item = static_cast<uint32_t>(begin); item < end; ++item) hashes[item] = hash(item);
  });
  const detail::Buckets dealt = detail::deal_out(hashes, bucket_bits);
  std::vector<uint32_t> first(count);
  parallel_for(dealt.first.size() - 1, 1, [&](uint64_t bucket, uint64_t) {
    const uint32_t begin = dealt.first[bucket], end = dealt.first[bucket + 1];
    // Open addressing, at most half full. An entry is a hash and an item; no item has the number that `free`
    // would be.
    constexpr uint64_t free = ~uint64_t(0);
    const uint64_t mask = std::bit_ceil(2 * uint64_t(end - begin) + 1) - 1;
    std::vector<uint64_t> table(mask + 1, free);
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t item = dealt.items[i];
      const uint32_t h = hashes[item];
      for (uint64_t slot = h & mask;; slot = (slot + 1) & mask) {
        const uint64_t entry = table[slot];
        const auto other = static_cast<uint32_t>(entry);
        if (entry == free) table[slot] = (uint64_t(h) << 32) | item;
        if (entry == free || (entry >> 32 == h && equal(item, other))) {
          first[item] = entry == free ? item : other;
          break;
        }
      }
    }
  });
  return first;
}

}  // namespace lodestone::geometry_image
