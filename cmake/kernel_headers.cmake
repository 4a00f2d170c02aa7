# photongrid_kernel_headers(OUTPUT folder ROOT folder BASE folder FILES file... [ALWAYS_WHOLE kernel...])
#
# Writes a header `stage/x.kernel.hpp` in OUTPUT for each kernel file `stage/x.glsl` under ROOT, at configure time. It
# holds
# - the file's text, photongrid::kernel_texts::x, which shader compilers read;
# - for a kernel (a file that defines `kernel` or `holds`), the struct photongrid::kernels::x made of the file, and the
#   texts of all files that it includes: own_texts();
# - for a file that kernels share, its functions, in photongrid::kernels.
# Files include each other as <photongrid/stage/x.glsl>. Texts are named relative to BASE.
#
# Where PHOTONGRID_KERNELS_ARE_COMPILED is defined, a kernel's header only declares its struct: enough for a file whose
# algorithms another object file has compiled (backends/any/compiled_algorithms.hpp), which an edit of the kernel then
# does not make stale. ALWAYS_WHOLE: kernels that code which is not a template uses.
function(photongrid_kernel_headers)
  cmake_parse_arguments(arg "" "OUTPUT;ROOT;BASE" "FILES;ALWAYS_WHOLE" ${ARGN})
  foreach(file IN LISTS arg_FILES)
    file(RELATIVE_PATH path "${arg_ROOT}" "${file}")
    get_filename_component(name "${file}" NAME_WE)
    photongrid_text_file("${file}" "${arg_BASE}" entry)
    file(READ "${file}" text)
    photongrid_included_kernels("${file}" "${arg_ROOT}" included)
    set(includes "")
    set(texts "${name}")
    foreach(other IN LISTS included)
      string(REPLACE ".glsl" ".kernel.hpp" header "${other}")
      get_filename_component(other_name "${other}" NAME_WE)
      string(APPEND includes "#include <${header}>\n")
      string(APPEND texts ", ${other_name}")
    endforeach()
    set(content "// Made by CMake (cmake/kernel_headers.cmake) of ${path}; do not edit.\n#pragma once\n\n${includes}#include <photongrid/core/text_file.hpp>\n")
    if(text MATCHES "\n(void kernel|bool holds)\\(")
      if(name IN_LIST arg_ALWAYS_WHOLE)
        string(APPEND content "\n#if 1")
      else()
        string(APPEND content "\nnamespace photongrid::kernels {\nstruct ${name};\n} // namespace photongrid::kernels\n
#if !defined(PHOTONGRID_KERNELS_ARE_COMPILED)")
      endif()
      string(APPEND content "\n#include <photongrid/core/begin.hpp>\n
namespace photongrid::kernel_texts {
inline constexpr text_file ${name} = ${entry};
inline constexpr text_file ${name}_and_included[] = {${texts}};
} // namespace photongrid::kernel_texts

namespace photongrid::kernels {
struct ${name} {
#include <${path}>
    static constexpr std::span<const text_file> own_texts() { return kernel_texts::${name}_and_included; }
};
} // namespace photongrid::kernels

#include <photongrid/core/end.hpp>
#endif
")
    else()
      string(APPEND content "
namespace photongrid::kernel_texts {
inline constexpr text_file ${name} = ${entry};
} // namespace photongrid::kernel_texts
")
      if(text MATCHES "#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT")
        string(APPEND content "
#include <glm/glm.hpp>
#include <glm/integer.hpp>
#include <photongrid/core/kernel.hpp>

#include <photongrid/core/exact_begin.hpp>

#pragma push_macro(\"precise\")
#undef precise
#define precise
namespace photongrid::kernels {
using namespace glm; // kernels are GLSL: its names are GLM's
#include <${path}>
} // namespace photongrid::kernels
#undef precise
#pragma pop_macro(\"precise\")

#include <photongrid/core/exact_end.hpp>
")
      endif()
    endif()
    string(REPLACE ".glsl" ".kernel.hpp" header "${path}")
    photongrid_write_if_changed("${arg_OUTPUT}/${header}" "${content}")
  endforeach()
endfunction()

# photongrid_included_kernels(FILE ROOT RESULT): sets RESULT to the kernel files of ROOT that FILE includes, directly or
# through others, as paths in ROOT; those that others need come first.
function(photongrid_included_kernels file root result)
  set(all "")
  file(STRINGS "${file}" lines REGEX "^#include <photongrid/.*\\.glsl>")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^#include <(.*)>.*" "\\1" path "${line}")
    if(NOT EXISTS "${root}/${path}")
      message(FATAL_ERROR "${file}: includes <${path}>, which is not in ${root}")
    endif()
    photongrid_included_kernels("${root}/${path}" "${root}" deeper)
    list(APPEND all ${deeper} "${path}")
  endforeach()
  list(REMOVE_DUPLICATES all)
  set(${result} "${all}" PARENT_SCOPE)
endfunction()
