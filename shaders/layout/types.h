// SPDX-License-Identifier: MIT
// The bridge between the two languages: every header of this folder is compiled as GLSL by the kernels and as
// C++ by the host and the CPU fallback. What is written in them uses only operations that give the same bits
// in both:
// + - * / sqrt floor, comparisons, selects and integers. (The shader build rejects the others.)
//
// The CPU fallback compiles some of them once more for many invocations side by side, one a vector lane
// (cpu_fallback/varying/layout-inl.h lists them). In those, what differs between invocations is a vec1,
// uvec1, ivec1 or bvec1, which is a plain number but there; a bvec1 is asked by select(), a bool by if and
// ?:.
#ifndef LODESTONE_LAYOUT_TYPES_H
#define LODESTONE_LAYOUT_TYPES_H

#ifdef __cplusplus

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#define LODESTONE_LAYOUT_BEGIN namespace lodestone::layout {
#define LODESTONE_LAYOUT_END }
#define FN inline
#define IN(T) const T&
#define OUT(T) T&
#define INOUT(T) T&
#define CONST inline constexpr

LODESTONE_LAYOUT_BEGIN
using glm::ivec2;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;
using vec1 = float;
using uvec1 = uint;
using ivec1 = int;
using bvec1 = bool;
template <class T>
FN T select(bool condition, T yes, T no) {
  return condition ? yes : no;
}
FN bool any_lane(bool condition) {
  return condition;
}
FN uint floatBitsToUint(float x) {
  return std::bit_cast<uint>(x);
}
FN float uintBitsToFloat(uint x) {
  return std::bit_cast<float>(x);
}
FN int findLSB(uint x) {
  return x == 0 ? -1 : std::countr_zero(x);
}
FN int findMSB(uint x) {
  return x == 0 ? -1 : 31 - std::countl_zero(x);
}
FN int bitCount(uint x) {
  return std::popcount(x);
}
FN uint bitfieldReverse(uint x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}
FN float sqrt(float x) {
  return std::sqrt(x);
}
FN float floor(float x) {
  return std::floor(x);
}
LODESTONE_LAYOUT_END

#else

#define LODESTONE_LAYOUT_BEGIN
#define LODESTONE_LAYOUT_END
#define FN
#define IN(T) T
#define OUT(T) out T
#define INOUT(T) inout T
#define CONST const
#define vec1 float
#define uvec1 uint
#define ivec1 int
#define bvec1 bool
#define select(condition, yes, no) ((condition) ? (yes) : (no))
#define any_lane(condition) (condition)

#endif
#endif
