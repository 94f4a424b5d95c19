// SPDX-License-Identifier: MIT
// The compute kernels, compiled and checked at build time and carried in the binary.
//
// shaders/FOLDER/NAME.comp becomes four kernels (shaders/kernel.glsl): `FOLDER/NAME`, whose word and quad
// bindings are storage buffers, `FOLDER/NAME_texel`, where they are storage texel buffers,
// `FOLDER/NAME_pairs`, where all but quads that are only written are, and `FOLDER/NAME_split`, which gets the
// addresses of large arrays.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace lodestone::kernels {

struct Kernel {
  std::string_view name;            // "geometry_image/bounds"
  std::span<const uint32_t> words;  // SPIR-V 1.5
};

// All of them, ordered by name.
std::span<const Kernel> all_kernels();

// The SPIR-V of a kernel of `set`, which is ordered by name; empty where there is none.
std::span<const uint32_t> find_kernel(std::span<const Kernel> set, std::string_view name);
inline std::span<const uint32_t> find_kernel(std::string_view name) {
  return find_kernel(all_kernels(), name);
}

}  // namespace lodestone::kernels
