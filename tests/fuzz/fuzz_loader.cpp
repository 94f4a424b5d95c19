// SPDX-License-Identifier: MIT
// The entry of libFuzzer, compiled once a format: LODESTONE_FUZZ_FORMAT is its name.
#include <cstddef>
#include <cstdint>
#include <span>

#include "load_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const lodestone::fuzz::ScratchFolder folder;
  lodestone::fuzz::load_bytes(LODESTONE_FUZZ_FORMAT, std::as_bytes(std::span(data, size)), folder.path());
  return 0;
}
