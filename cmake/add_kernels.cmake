# photongrid_add_kernels(target [NAMESPACE name] KERNELS file... [INCLUDED file...])
#
# Kernels of your own, for every backend. Gives `target` the header <NAME_kernels.hpp>, in which each of KERNELS is a
# struct of its file's name (mean.glsl: mean) in the namespace NAME (without one: `target`), to be run as
# device.run<NAME::mean>(...). Kernels may #include "..." those of INCLUDED, which are guarded like headers and hold
# `inline` functions, and photongrid's own as <photongrid/...glsl>. Their texts go into the program, so that nothing is
# read when it runs; a mistake in one is reported at its own file and line. GPUs find an included file as C++ does: beside
# the including file, or by its whole path; so files in different folders may have the same name, but no two KERNELS.
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
  get_property(root GLOBAL PROPERTY photongrid_include_folder)
  set(includes "")
  set(structs "")
  set(files "")
  set(kernels "")
  set(library "")
  foreach(kind IN ITEMS INCLUDED KERNELS)
    foreach(file IN LISTS arg_${kind})
      get_filename_component(path "${file}" ABSOLUTE)
      get_filename_component(name "${file}" NAME_WE)
      if(NOT EXISTS "${path}")
        message(FATAL_ERROR "photongrid_add_kernels(${target}): there is no file ${path}")
      endif()
      photongrid_included_kernels("${path}" "${root}" included)
      list(APPEND library ${included})
      list(APPEND files "${path}")
      if(kind STREQUAL INCLUDED)
        string(APPEND includes "#include \"${path}\"\n")
      elseif(NOT name MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
        message(FATAL_ERROR "photongrid_add_kernels(${target}): ${file}: \"${name}\" cannot be the name of a struct; rename the file")
      else()
        list(APPEND kernels "${path}")
        string(APPEND structs "struct ${name} {\n#include \"${path}\"\n    static constexpr std::span<const photongrid::text_file> own_texts() { return kernel_texts; }\n};\n")
      endif()
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES library)
  photongrid_refuse_ambiguous_kernels("photongrid_add_kernels(${target})" "${files}" "${kernels}" "${library}")
  set(headers "")
  foreach(path IN LISTS library)
    string(REPLACE ".glsl" ".kernel.hpp" header "${path}")
    string(APPEND headers "#include <${header}>\n")
    list(APPEND files "${root}/${path}")
  endforeach()

  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}_kernels)
  photongrid_embed(OUTPUT ${folder}/${arg_NAMESPACE}_kernel_text.hpp TABLE kernel_texts NAMESPACE ${arg_NAMESPACE} BASE ${CMAKE_CURRENT_SOURCE_DIR} FILES ${files})
  photongrid_write_if_changed(${folder}/${arg_NAMESPACE}_kernels.hpp "// Made by CMake (photongrid_add_kernels); do not edit.
#pragma once

#include <${arg_NAMESPACE}_kernel_text.hpp>
${headers}#include <photongrid/core/kernel.hpp>

#include <span>

#include <photongrid/core/begin.hpp>

namespace ${arg_NAMESPACE} {

using namespace photongrid::kernels;

${includes}
${structs}
} // namespace ${arg_NAMESPACE}

#include <photongrid/core/end.hpp>
")
  get_target_property(type ${target} TYPE)
  set(scope PRIVATE)
  if(type STREQUAL INTERFACE_LIBRARY)
    set(scope INTERFACE)
  endif()
  target_include_directories(${target} ${scope} ${folder})
  target_link_libraries(${target} ${scope} photongrid::photongrid)
endfunction()

# photongrid_refuse_ambiguous_kernels(CALL FILES KERNELS LIBRARY): an error if one of FILES is given twice, if two of KERNELS
# would be structs of the same name, or if one of FILES could be meant by an #include <...> of one of photongrid's LIBRARY.
function(photongrid_refuse_ambiguous_kernels call files kernels library)
  set(once ${files})
  list(REMOVE_DUPLICATES once)
  foreach(file IN LISTS files)
    list(FIND once "${file}" at)
    if(at EQUAL -1)
      message(FATAL_ERROR "${call}: ${file} is given twice")
    endif()
    list(REMOVE_AT once ${at})
    foreach(path IN LISTS library)
      if("${file}" MATCHES "/${path}$")
        message(FATAL_ERROR "${call}: on GPUs ${file} cannot be told from photongrid's own <${path}>; rename the file or its folder")
      endif()
    endforeach()
  endforeach()
  foreach(file IN LISTS kernels)
    get_filename_component(name "${file}" NAME_WE)
    if(DEFINED file_of_${name})
      message(FATAL_ERROR "${call}: ${file_of_${name}} and ${file} would both be the struct ${name}; rename a file, or call photongrid_add_kernels twice with two NAMESPACEs")
    endif()
    set(file_of_${name} "${file}")
  endforeach()
endfunction()
