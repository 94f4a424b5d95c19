// SPDX-License-Identifier: MIT
// Under a leak sanitizer: drivers and layers stay loaded to the end, so that what they leak is known as
// theirs and left out (tests/support/known_leaks.cpp), while a leak of ours is still found. The loader would
// unload them, and their leaks would be nobody's.
#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

#if defined(__SANITIZE_ADDRESS__)
#define LODESTONE_FINDS_LEAKS
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LODESTONE_FINDS_LEAKS
#endif
#endif

#ifdef LODESTONE_FINDS_LEAKS

namespace {

bool pin(const char* library) {
  return dlopen(library, RTLD_NOW | RTLD_NODELETE) != nullptr;
}

const bool pinned = [] {
  for (const char* library : {"libvulkan.so.1", "libvulkan_lvp.so", "libVkLayer_khronos_validation.so",
                              "libVkLayer_MESA_device_select.so"}) {
    pin(library);
  }
  if (const char* file = std::getenv("LODESTONE_SWIFTSHADER_ICD"); file != nullptr && *file != 0) {
    pin((std::filesystem::path(file).parent_path() / "libvk_swiftshader.so").c_str());
  }
  return true;
}();

}  // namespace

#endif
