// SPDX-License-Identifier: MIT
// spirv_embed SYMBOL IN.spv OUT.cpp: a module as a C++ array SYMBOL, and its length SYMBOL_words.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: spirv_embed SYMBOL IN.spv OUT.cpp\n");
    return 2;
  }
  const std::string symbol = argv[1];
  std::ifstream in(argv[2], std::ios::binary);
  std::ofstream out(argv[3]);
  out << "#include <cstddef>\n#include <cstdint>\n"
      << "extern const std::uint32_t " << symbol << "[];\nextern const std::size_t " << symbol << "_words;\n"
      << "const std::uint32_t " << symbol << "[] = {";
  uint32_t word = 0;
  size_t count = 0;
  for (; in.read(reinterpret_cast<char*>(&word), sizeof(word)); ++count) {
    out << (count % 12 == 0 ? "\n" : "") << word << "u,";
  }
  out << "};\nconst std::size_t " << symbol << "_words = " << count << ";\n";
  out.close();
  if (count == 0 || !out) {
    std::fprintf(stderr, "%s: cannot be embedded into %s\n", argv[2], argv[3]);
    return 1;
  }
  return 0;
}
