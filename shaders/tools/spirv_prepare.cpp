// SPDX-License-Identifier: MIT
// spirv_prepare KERNEL IN.spv OUT.spv: rejects a kernel whose bits would differ between devices and forbids
// contraction in the others. KERNEL is the name that messages use.
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "arithmetic_rules.h"

namespace {

std::vector<uint32_t> read_words(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::vector<uint32_t> words(size_t(file.tellg()) / sizeof(uint32_t));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(words.data()), std::streamsize(words.size() * sizeof(uint32_t)));
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return words;
}

void write_words(const std::string& path, const std::vector<uint32_t>& words) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(words.data()), std::streamsize(words.size() * sizeof(uint32_t)));
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: spirv_prepare KERNEL IN.spv OUT.spv\n");
    return 2;
  }
  try {
    const lodestone::spirv::Module module(read_words(argv[2]));
    const std::vector<std::string> findings = lodestone::spirv::find_unportable(module);
    for (const std::string& finding : findings)
      std::fprintf(stderr, "%s: error: %s\n", argv[1], finding.c_str());
    if (!findings.empty()) return 1;
    write_words(argv[3], lodestone::spirv::forbid_contraction(module));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: error: %s\n", argv[1], error.what());
    return 1;
  }
  return 0;
}
