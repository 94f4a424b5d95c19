// SPDX-License-Identifier: MIT
// What every kernel starts with: its index, its buffers and its counters. Buffers of words (4 bytes) and quads (16
// bytes) are storage buffers in one variant of each kernel and texel buffers in two others (on lavapipe nearly twice as
// fast to read, and with room for 2 GiB). In the second of these quads that are only written are storage buffers all
// the same, of 64-bit numbers: lavapipe stores lane by lane and number by number. The last variant is for arrays that
// none of these can show whole; it reaches those by addresses. Kernels name their buffers only through these macros.
#extension GL_EXT_scalar_block_layout : require
#if LODESTONE_PAIR_STORES
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif

#include "layout/counters.h"
#include "layout/types.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint counting = 0u;

uint words_read = 0u;
uint words_written = 0u;

// `counting` is 0 or 1. No branches: SwiftShader's time to compile a loop grows exponentially with them.
void count_read(uint words) { words_read += counting * words; }
void count_write(uint words) { words_written += counting * words; }

#define DATA(slot, access, type, name) layout(set = 0, binding = slot, scalar) access buffer name##_block { type name[]; }
#if LODESTONE_TEXEL_BUFFERS
// Of each array name##_load and name##_store, as far as it may be read and written.
#define TEXELS(slot, access, format, name) layout(set = 0, binding = slot, format) uniform access uimageBuffer name
#define QUADS(slot, access, name) QUADS_FOR(access, slot, name)  // so that an access that is a macro is expanded
#define QUADS_FOR(access, slot, name) QUADS_##access(slot, name)
#define QUADS_readonly(slot, name)              \
  TEXELS(slot, readonly, rgba32ui, name);       \
  uvec4 name##_load(uint i) { return imageLoad(name, int(i)); }
#define QUADS_restrict(slot, name)        \
  TEXELS(slot, restrict, rgba32ui, name); \
  uvec4 name##_load(uint i) { return imageLoad(name, int(i)); } \
  void name##_store(uint i, uvec4 value) { imageStore(name, int(i), value); }
#if LODESTONE_PAIR_STORES
#define QUADS_writeonly(slot, name)        \
  DATA(slot, writeonly, u64vec2, name);    \
  void name##_store(uint i, uvec4 value) { name[i] = u64vec2(packUint2x32(value.xy), packUint2x32(value.zw)); }
#else
#define QUADS_writeonly(slot, name)        \
  TEXELS(slot, writeonly, rgba32ui, name); \
  void name##_store(uint i, uvec4 value) { imageStore(name, int(i), value); }
#endif
#define WORDS(slot, access, name) TEXELS(slot, access, r32ui, name)
#define RAW_LOAD4(name, i) name##_load(uint(i))
#define RAW_LOAD1(name, i) imageLoad(name, int(i)).x
#define RAW_STORE4(name, i, value) name##_store(uint(i), value)
#define RAW_STORE1(name, i, value) imageStore(name, int(i), uvec4(value))
#else
#if LODESTONE_SPLIT_BUFFERS
// An array is cut into segments of 2^segment_shift bytes. A binding shows either the array or, where its bit is set in
// `addressed`, the addresses of the array's segments; all pipelines know at their creation which.
#extension GL_EXT_buffer_reference_uvec2 : require
layout(constant_id = 8) const uint addressed = 0u;
layout(constant_id = 9) const uint segment_shift = 31u;
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer QuadSegment { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer WordSegment { uint at[]; };
#define SPLIT_DATA(slot, access, type, name)                                                                              \
  DATA(slot, access, type, name);                                                                                         \
  layout(set = 0, binding = slot, scalar) readonly buffer name##_segments_block { uvec2 name##_segments[]; };             \
  const uint name##_bit = 1u << slot
#define QUADS(slot, access, name) SPLIT_DATA(slot, access, uvec4, name)
#define WORDS(slot, access, name) SPLIT_DATA(slot, access, uint, name)
#define IN_SEGMENT(segment, name, i, shift) segment(name##_segments[(i) >> (shift)]).at[(i) & ((1u << (shift)) - 1u)]
#define IN_SEGMENT4(name, i) IN_SEGMENT(QuadSegment, name, i, segment_shift - 4u)
#define IN_SEGMENT1(name, i) IN_SEGMENT(WordSegment, name, i, segment_shift - 2u)
#else
#define QUADS(slot, access, name) DATA(slot, access, uvec4, name)
#define WORDS(slot, access, name) DATA(slot, access, uint, name)
#endif
#define RAW_LOAD4(name, i) name[i]
#define RAW_LOAD1(name, i) name[i]
#define RAW_STORE4(name, i, value) name[i] = value
#define RAW_STORE1(name, i, value) name[i] = value
#endif
#define STRUCTS(slot, access, type, name) layout(set = 0, binding = slot, scalar) access buffer name##_block { type name[]; }

#if LODESTONE_SPLIT_BUFFERS
#define IF_SPLIT(name, statement) if ((addressed & name##_bit) != 0u) { statement; } else
#else
#define IF_SPLIT(name, statement)
#endif

#define LOAD4(result, name, i) \
  {                            \
    IF_SPLIT(name, result = IN_SEGMENT4(name, i)) \
    result = RAW_LOAD4(name, i); \
    count_read(4u);            \
  }
#define LOAD1(result, name, i) \
  {                            \
    IF_SPLIT(name, result = IN_SEGMENT1(name, i)) \
    result = RAW_LOAD1(name, i); \
    count_read(1u);            \
  }
#define STORE4(name, i, value)    \
  {                               \
    IF_SPLIT(name, IN_SEGMENT4(name, i) = value) \
    RAW_STORE4(name, i, value);   \
    count_write(4u);              \
  }
#define STORE1(name, i, value)    \
  {                               \
    IF_SPLIT(name, IN_SEGMENT1(name, i) = value) \
    RAW_STORE1(name, i, value);   \
    count_write(1u);              \
  }

#define PUSH(type, name) layout(push_constant, scalar) uniform name##_block { type name; }

// The last binding of every kernel.
#define COUNTERS(slot) \
  layout(set = 0, binding = slot, scalar) buffer counters_block { uint counters[]; }; \
  void count(uint counter, uint amount) {                                             \
    uint before = atomicAdd(counters[counter], amount);                              \
    if (before + amount < before) atomicAdd(counters[counter_count + counter], 1u);  \
  }                                                                                  \
  void flush_counters() {                                                            \
    if (counting != 0u) {                                                            \
      count(counter_bytes_read, words_read);                                         \
      count(counter_bytes_written, words_written);                                   \
    }                                                                                \
  }

uint invocation() { return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x; }

vec3 as_vec3(uvec4 bits) { return vec3(uintBitsToFloat(bits.x), uintBitsToFloat(bits.y), uintBitsToFloat(bits.z)); }
vec4 as_vec4(uvec4 bits) { return vec4(as_vec3(bits), uintBitsToFloat(bits.w)); }
uvec4 as_bits(vec3 v, uint w) { return uvec4(floatBitsToUint(v.x), floatBitsToUint(v.y), floatBitsToUint(v.z), w); }
uvec4 as_bits(vec4 v) { return uvec4(floatBitsToUint(v.x), floatBitsToUint(v.y), floatBitsToUint(v.z), floatBitsToUint(v.w)); }
