// SPDX-License-Identifier: MIT
// Leaks of libraries that are none of ours, for the leak sanitizer; without it nothing calls this.
extern "C" const char* __lsan_default_suppressions();

extern "C" const char* __lsan_default_suppressions() {
  // OpenImageIO 2.4 hands libpng the message `Read error: hit end of file` in a temporary string, and libpng
  // leaves by longjmp: some 31 bytes a PNG that is cut short.
  return "leak:OpenImageIO*ImageInput::geterror\n";
}
