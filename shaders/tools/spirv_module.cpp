// SPDX-License-Identifier: MIT
#include "spirv_module.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace lodestone::spirv {

namespace {
constexpr size_t header_words = 5;
}

Module::Module(std::vector<uint32_t> words) : words_(std::move(words)) {
  if (words_.size() < header_words || words_[0] != spv::MagicNumber) {
    throw std::runtime_error("not a SPIR-V module");
  }
  for_each([&](const Instruction& instruction) {
    if (instruction.op == spv::OpName && instruction.words.size() > 2) {
      names_[instruction.words[1]] = read_string(instruction.words, 2);
    }
  });
}

void Module::for_each(const std::function<void(const Instruction&)>& visit) const {
  for (size_t offset = header_words; offset < words_.size();) {
    const uint32_t length = words_[offset] >> spv::WordCountShift;
    if (length == 0 || offset + length > words_.size()) {
      throw std::runtime_error(fmt::format("SPIR-V is cut off at word {}", offset));
    }
    const auto op = spv::Op(words_[offset] & spv::OpCodeMask);
    visit({op, offset, std::span(words_).subspan(offset, length)});
    offset += length;
  }
}

std::string Module::name_of(uint32_t id) const {
  const auto found = names_.find(id);
  return found == names_.end() || found->second.empty() ? fmt::format("%{}", id) : found->second;
}

std::string read_string(std::span<const uint32_t> words, size_t first) {
  std::string text;
  for (size_t i = first; i < words.size(); ++i) {
    for (uint32_t shift = 0; shift < 32; shift += 8) {
      const char c = char(words[i] >> shift & 0xffu);
      if (c == 0) return text;
      text += c;
    }
  }
  return text;
}

}  // namespace lodestone::spirv
