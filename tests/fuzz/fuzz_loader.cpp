// SPDX-License-Identifier: MIT
// The entry of libFuzzer, compiled once a format: LODESTONE_FUZZ_FORMAT is its name.
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "load_bytes.h"

// Tiny images do not need the thread pools of OpenImageIO and OpenEXR.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const lodestone::fuzz::ScratchFolder folder;
  lodestone::fuzz::load_bytes(LODESTONE_FUZZ_FORMAT, std::as_bytes(std::span(data, size)), folder.path());
  return 0;
}
