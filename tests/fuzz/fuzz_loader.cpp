// SPDX-License-Identifier: MIT
// The entry of libFuzzer, compiled once a format: LODESTONE_FUZZ_FORMAT is its name.
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "load_bytes.h"
#include "lodestone/base/parallel.h"

// Tiny files need no threads of ours, of OpenImageIO or of OpenEXR; without them a find can be repeated.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  lodestone::set_thread_count(1);
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const lodestone::fuzz::ScratchFolder folder;
  lodestone::fuzz::load_bytes(LODESTONE_FUZZ_FORMAT, std::as_bytes(std::span(data, size)), folder.path());
  return 0;
}
