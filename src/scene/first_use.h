// SPDX-License-Identifier: MIT
// Numbers for keys, in the order in which the keys are first used.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// Gives equal keys of N words equal numbers: 0 to the first key, 1 to the next one that is different from it,
// and so on. An open-addressing hash table with linear probing. At most 2^32 - 1 different keys.
template <size_t N>
class FirstUse {
 public:
  using Key = std::array<uint32_t, N>;

  FirstUse() : slots_(64, none) {}

  uint32_t number(const Key& key) {
    if (2 * (keys_.size() + 1) > slots_.size()) grow();
    uint32_t& slot = slots_[find(key)];
    if (slot == none) {
      slot = static_cast<uint32_t>(keys_.size());
      keys_.push_back(key);
    }
    return slot;
  }

  // Key by number.
  const std::vector<Key>& keys() const { return keys_; }

 private:
  // Drawn anew in every process, so that no file can be made whose keys all collide. Numbers do not depend on
  // it.
  static uint64_t seed() {
    static const uint64_t value = (uint64_t(std::random_device{}()) << 32) | std::random_device{}();
    return value;
  }

  // Multiplies by odd constants carry each word upwards, shifts bring it back down to the bits that choose a
  // slot.
  static uint64_t hash(const Key& key) {
    uint64_t state = seed();
    for (const uint32_t word : key) {
      state = (state ^ word) * 0x9fb21c651e98df25u;
      state ^= state >> 29;
    }
    state *= 0xd6e8feb86659fd93u;
    return state ^ (state >> 32);
  }

  size_t find(const Key& key) const {
    const size_t mask = slots_.size() - 1;
    size_t slot = hash(key) & mask;
    while (slots_[slot] != none && keys_[slots_[slot]] != key) slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    slots_.assign(slots_.size() * 2, none);
    for (uint32_t i = 0; i < keys_.size(); ++i) slots_[find(keys_[i])] = i;
  }

  std::vector<Key> keys_;
  std::vector<uint32_t> slots_;  // a power of two of them, at most half in use
};

}  // namespace lodestone::scene
