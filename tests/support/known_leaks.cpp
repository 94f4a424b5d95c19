// SPDX-License-Identifier: MIT
// Leaks of libraries that are none of ours, for the leak sanitizer; without it nothing calls this.
extern "C" const char* __lsan_default_suppressions();

extern "C" const char* __lsan_default_suppressions() {
  return
      // OpenImageIO 2.4 hands libpng the message `Read error: hit end of file` in a temporary string, and
      // libpng leaves by longjmp: some 31 bytes a PNG that is cut short.
      "leak:OpenImageIO*ImageInput::geterror\n"
      // Drivers and layers keep what they hold to the end of the process.
      "leak:libvulkan\nleak:libVkLayer\nleak:libvk_swiftshader\nleak:libLLVM\n";
}
