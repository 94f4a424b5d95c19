# lodestone_embed_kernels(TARGET ROOT NAMESPACE): compiles ROOT/FOLDER/NAME.comp, checks and embeds the result.
#
# Every source is compiled four times: for storage buffers, for storage texel buffers, for those but with quads stored as pairs of
# 64-bit numbers, and for arrays split over several buffers (shaders/kernel.glsl); spirv_prepare rejects what has other bits on other devices and forbids contraction;
# spirv-val judges the outcome. TARGET gets the arrays and a function `std::span<const lodestone::kernels::Kernel>
# NAMESPACE::all_kernels()`. Kernels include from ROOT and from shaders/.

find_program(LODESTONE_GLSLANG glslangValidator REQUIRED)
find_program(LODESTONE_SPIRV_VAL spirv-val REQUIRED)
set(LODESTONE_SHADERS ${PROJECT_SOURCE_DIR}/shaders CACHE INTERNAL "The folder that kernels include from")

function(lodestone_embed_kernels target root namespace)
  file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${root} ${root}/*/*.comp)
  set(names "")
  foreach(source ${sources})
    string(REGEX REPLACE "\\.comp$" "" name ${source})
    foreach(variant "" _texel _pairs _split)
      lodestone_embed_kernel(${target} ${root} ${source} ${name}${variant})
      list(APPEND names ${name}${variant})
    endforeach()
  endforeach()
  lodestone_index_kernels(${target} ${namespace} "${names}")
endfunction()

# One source to one array, in three steps with a file each: NAME.raw.spv, NAME.spv, NAME.cpp.
function(lodestone_embed_kernel target root source name)
  set(texel 0)
  set(pairs 0)
  set(split 0)
  if(name MATCHES "_texel$")
    set(texel 1)
  elseif(name MATCHES "_pairs$")
    set(texel 1)
    set(pairs 1)
  elseif(name MATCHES "_split$")
    set(split 1)
  endif()
  set(base ${CMAKE_CURRENT_BINARY_DIR}/kernels/${name})
  get_filename_component(folder ${base} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  string(MAKE_C_IDENTIFIER embedded_${target}_${name} symbol)
  add_custom_command(
    OUTPUT ${base}.raw.spv
    COMMAND ${LODESTONE_GLSLANG} --quiet -V --target-env vulkan1.2 $<$<CONFIG:Debug>:-g> -I${root} -I${LODESTONE_SHADERS}
            -DLODESTONE_TEXEL_BUFFERS=${texel} -DLODESTONE_PAIR_STORES=${pairs} -DLODESTONE_SPLIT_BUFFERS=${split} --depfile ${base}.d -o ${base}.raw.spv ${root}/${source}
    DEPENDS ${root}/${source}
    DEPFILE ${base}.d
    COMMENT "Compiling kernel ${name}"
    COMMAND_EXPAND_LISTS VERBATIM)
  add_custom_command(
    OUTPUT ${base}.cpp
    COMMAND lodestone_spirv_prepare ${name} ${base}.raw.spv ${base}.spv
    COMMAND ${LODESTONE_SPIRV_VAL} --target-env vulkan1.2 --scalar-block-layout ${base}.spv
    COMMAND lodestone_spirv_embed ${symbol} ${base}.spv ${base}.cpp
    DEPENDS ${base}.raw.spv lodestone_spirv_prepare lodestone_spirv_embed
    COMMENT "Checking kernel ${name}"
    VERBATIM)
  target_sources(${target} PRIVATE ${base}.cpp)
endfunction()

function(lodestone_index_kernels target namespace names)
  list(SORT names COMPARE STRING)
  set(declarations "")
  set(entries "")
  set(count 0)
  foreach(name ${names})
    string(MAKE_C_IDENTIFIER embedded_${target}_${name} symbol)
    string(APPEND declarations "extern const std::uint32_t ${symbol}[]@SEMI@\nextern const std::size_t ${symbol}_words@SEMI@\n")
    string(APPEND entries "      lodestone::kernels::Kernel{\"${name}\", {${symbol}, ${symbol}_words}},\n")
    math(EXPR count "${count} + 1")
  endforeach()
  string(REPLACE "@SEMI@" ";" declarations "${declarations}")
  set(index ${CMAKE_CURRENT_BINARY_DIR}/kernels/${target}_index.cpp)
  file(CONFIGURE OUTPUT ${index} @ONLY CONTENT [[
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "lodestone/kernels/kernels.h"

@declarations@
namespace @namespace@ {
std::span<const lodestone::kernels::Kernel> all_kernels();
std::span<const lodestone::kernels::Kernel> all_kernels() {
  static const std::array<lodestone::kernels::Kernel, @count@> set = {
@entries@  };
  return set;
}
}
]])
  target_sources(${target} PRIVATE ${index})
endfunction()
