# How every folder of the house becomes a target.
#
# lodestone_library(NAME SOURCES... DEPENDS ...) makes of the current folder the static library lodestone_NAME with an
# include root of its own: a directory in the build tree that holds nothing but a link lodestone/NAME to it. So
# `#include "lodestone/scene/scene.h"` compiles only in a target that depends on lodestone_scene.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(LODESTONE_CCACHE ccache)
if(LODESTONE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # What ccache asks for where headers are precompiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${LODESTONE_CCACHE})
endif()

# Headers of others that most files read: two thirds of the time of compiling a file that does little.
# CMAKE_DISABLE_PRECOMPILE_HEADERS=ON (the presets of the sanitizers) shows whether each file includes what it uses.
set(LODESTONE_PRECOMPILED <algorithm> <filesystem> <fstream> <functional> <map> <optional> <random> <sstream> <string> <vector>
    <fmt/format.h> <glm/glm.hpp>)

add_library(lodestone_options INTERFACE)
set_target_properties(lodestone_options PROPERTIES EXPORT_NAME options)
target_compile_features(lodestone_options INTERFACE cxx_std_20)
target_compile_options(lodestone_options INTERFACE
  # One arithmetic: no fused multiply-add behind our back, so that C++ gives the bits of the kernels.
  -ffp-contract=off -fno-math-errno
  $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow -Werror>)
if(LODESTONE_SANITIZE)
  # Line tables are all that a report needs, and a fifth of the compile time less.
  target_compile_options(lodestone_options INTERFACE -fsanitize=${LODESTONE_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all -g1)
  target_compile_definitions(lodestone_options INTERFACE _GLIBCXX_ASSERTIONS)
  target_link_options(lodestone_options INTERFACE -fsanitize=${LODESTONE_SANITIZE})
endif()

function(lodestone_include_root target name folder)
  set(root ${CMAKE_BINARY_DIR}/roots/${name})
  file(MAKE_DIRECTORY ${root}/lodestone)
  file(CREATE_LINK ${folder} ${root}/lodestone/${name} SYMBOLIC)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL INTERFACE_LIBRARY)
    set(scope INTERFACE)
  else()
    set(scope PUBLIC)
  endif()
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${root}> $<INSTALL_INTERFACE:include>)
endfunction()

# The first library to ask makes the headers, the others take them.
function(lodestone_precompile target)
  get_property(maker GLOBAL PROPERTY LODESTONE_PRECOMPILED_BY)
  if(maker)
    target_precompile_headers(${target} REUSE_FROM ${maker})
  else()
    target_precompile_headers(${target} PRIVATE ${LODESTONE_PRECOMPILED})
    set_property(GLOBAL PROPERTY LODESTONE_PRECOMPILED_BY ${target})
  endif()
endfunction()

function(lodestone_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(lodestone_${name} STATIC ${arg_SOURCES})
  add_library(lodestone::${name} ALIAS lodestone_${name})
  set_target_properties(lodestone_${name} PROPERTIES EXPORT_NAME ${name})
  lodestone_include_root(lodestone_${name} ${name} ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(lodestone_${name} PUBLIC lodestone_options ${arg_DEPENDS} PRIVATE ${arg_PRIVATE_DEPENDS})
  lodestone_precompile(lodestone_${name})
  set_property(GLOBAL APPEND PROPERTY LODESTONE_LIBRARIES lodestone_${name})
endfunction()
