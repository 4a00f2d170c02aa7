# photongrid_embed(OUTPUT header TABLE name [NAMESPACE name] FILES file...)
#
# Writes a header that holds the text of each file, byte for byte, as `inline constexpr photongrid::text_file TABLE[]`
# in NAMESPACE (or photongrid), at configure time. Editing a file configures again. Names are shown relative to BASE (in
# messages of shader compilers).
function(photongrid_embed)
  cmake_parse_arguments(arg "" "OUTPUT;TABLE;NAMESPACE;BASE" "FILES" ${ARGN})
  if(NOT arg_NAMESPACE)
    set(arg_NAMESPACE photongrid)
  endif()
  set(entries "")
  foreach(file IN LISTS arg_FILES)
    photongrid_text_file("${file}" "${arg_BASE}" entry)
    string(APPEND entries "    ${entry},\n")
  endforeach()
  list(LENGTH arg_FILES count)
  photongrid_write_if_changed("${arg_OUTPUT}" "// Made by CMake (cmake/embed.cmake); do not edit.
#pragma once
#include <photongrid/core/text_file.hpp>
namespace ${arg_NAMESPACE} {
inline constexpr photongrid::text_file ${arg_TABLE}[${count}] = {
${entries}};
} // namespace ${arg_NAMESPACE}
")
endfunction()

# photongrid_text_file(FILE BASE RESULT): sets RESULT to the C++ initializer of a photongrid::text_file with FILE's text.
function(photongrid_text_file file base result)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  file(READ "${file}" text)
  file(RELATIVE_PATH name "${base}" "${file}")
  set(${result} "photongrid::text_file{\"${name}\", R\"glsl(${text})glsl\"}" PARENT_SCOPE)
endfunction()

# photongrid_write_if_changed(FILE CONTENT): keeps FILE's time when it holds CONTENT already.
function(photongrid_write_if_changed file content)
  if(EXISTS "${file}")
    file(READ "${file}" old)
  endif()
  if(NOT "${old}" STREQUAL "${content}")
    file(WRITE "${file}" "${content}")
  endif()
endfunction()
