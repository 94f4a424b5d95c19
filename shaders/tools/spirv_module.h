// SPDX-License-Identifier: MIT
// A SPIR-V module as a run of instructions, with the few tables that messages and rules need.
#pragma once

#include <glslang/SPIRV/spirv.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace lodestone::spirv {

struct Instruction {
  spv::Op op = spv::OpNop;
  size_t offset = 0;                // of its first word in the module
  std::span<const uint32_t> words;  // words[0] is length and opcode
};

class Module {
 public:
  // Throws std::runtime_error where the words are not a module in this machine's byte order.
  explicit Module(std::vector<uint32_t> words);

  std::span<const uint32_t> words() const { return words_; }
  void for_each(const std::function<void(const Instruction&)>& visit) const;

  // What the source calls an id; "%12" where it has no name.
  std::string name_of(uint32_t id) const;

 private:
  std::vector<uint32_t> words_;
  std::unordered_map<uint32_t, std::string> names_;
};

// The zero-terminated string that starts at words[first].
std::string read_string(std::span<const uint32_t> words, size_t first);

}  // namespace lodestone::spirv
