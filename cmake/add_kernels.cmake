# photongrid_add_kernels(target [NAMESPACE name] KERNELS file... [INCLUDED file...])
#
# Kernels of your own, for every backend. Gives `target` the header <NAME_kernels.hpp>, in which each of KERNELS is a struct of
# its file's name (mean.glsl: mean) in the namespace NAME (without one: `target`), to be run as device.run<NAME::mean>(...). Kernels
# may #include "..." those of INCLUDED, which are guarded like headers and hold `inline` functions, and photongrid's own.
# Their texts go into the program, so that nothing is read when it runs; a mistake in one is reported at its own file and line.
function(photongrid_add_kernels target)
  cmake_parse_arguments(arg "" "NAMESPACE" "KERNELS;INCLUDED" ${ARGN})
  if(NOT TARGET ${target})
    message(FATAL_ERROR "photongrid_add_kernels: there is no target \"${target}\"; call add_executable or add_library first")
  endif()
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_KERNELS)
    message(FATAL_ERROR "photongrid_add_kernels(${target}): expected KERNELS file...${arg_UNPARSED_ARGUMENTS}; see cmake/add_kernels.cmake")
  endif()
  if(NOT arg_NAMESPACE)
    set(arg_NAMESPACE ${target})
  endif()
  set(includes "")
  set(structs "")
  set(files "")
  foreach(kind IN ITEMS INCLUDED KERNELS)
    foreach(file IN LISTS arg_${kind})
      get_filename_component(path "${file}" ABSOLUTE)
      get_filename_component(name "${file}" NAME_WE)
      if(NOT EXISTS "${path}")
        message(FATAL_ERROR "photongrid_add_kernels(${target}): there is no file ${path}")
      endif()
      list(APPEND files "${path}")
      if(kind STREQUAL INCLUDED)
        string(APPEND includes "#include \"${path}\"\n")
      elseif(NOT name MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
        message(FATAL_ERROR "photongrid_add_kernels(${target}): ${file}: \"${name}\" cannot be the name of a struct; rename the file")
      else()
        string(APPEND structs "struct ${name} {\n#include \"${path}\"\n    static constexpr std::span<const photongrid::text_file> own_texts() { return kernel_texts; }\n};\n")
      endif()
    endforeach()
  endforeach()

  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}_kernels)
  photongrid_embed(OUTPUT ${folder}/${arg_NAMESPACE}_kernel_text.hpp TABLE kernel_texts NAMESPACE ${arg_NAMESPACE} BASE ${CMAKE_CURRENT_SOURCE_DIR} FILES ${files})
  file(CONFIGURE OUTPUT ${folder}/${arg_NAMESPACE}_kernels.hpp CONTENT "// Made by CMake (photongrid_add_kernels); do not edit.
#pragma once

#include <${arg_NAMESPACE}_kernel_text.hpp>
#include <photongrid/kernel.hpp>

#include <span>

#include <photongrid/kernels/begin.hpp>

namespace ${arg_NAMESPACE} {

using namespace photongrid::kernels;

${includes}
${structs}
} // namespace ${arg_NAMESPACE}

#include <photongrid/kernels/end.hpp>
" @ONLY)
  get_property(kernel_folder GLOBAL PROPERTY photongrid_kernel_folder)
  target_include_directories(${target} PRIVATE ${folder} ${kernel_folder})
  target_link_libraries(${target} PRIVATE photongrid::photongrid)
endfunction()
