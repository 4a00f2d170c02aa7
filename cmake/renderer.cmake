# photongrid::renderer: the renderer, compiled once for each backend that is built, which is chosen at run time.

# photongrid_built_backends(FILE NAME...): the source file that lists these backends to backends/any.
function(photongrid_built_backends file)
  set(entries ${ARGN})
  list(TRANSFORM entries APPEND "_entry()")
  list(JOIN entries ", " entries)
  file(CONFIGURE OUTPUT ${file} CONTENT [[
// The backends that are built in: cmake/renderer.cmake.
#include <photongrid/backends/any/backend_entry.hpp>

std::span<const photongrid::any::backend_entry> photongrid::any::built_backends()
{
    static const backend_entry all[] = {@entries@};
    return all;
}
]] @ONLY)
endfunction()

set(root ${PROJECT_BINARY_DIR}/backends/any)
file(MAKE_DIRECTORY ${root}/photongrid/backends)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/backends/any ${root}/photongrid/backends/any SYMBOLIC)
set(sources "")
set(names "")
set(libraries "")
foreach(name IN ITEMS serial cpu gl vulkan)
  if(TARGET photongrid::${name})
    list(APPEND sources ${PROJECT_SOURCE_DIR}/backends/any/${name}.cpp)
    list(APPEND names ${name})
    if(TARGET photongrid_${name}_compiled)
      list(APPEND libraries photongrid_${name}_compiled)
    else()
      list(APPEND libraries photongrid_${name})
    endif()
  endif()
endforeach()
photongrid_built_backends(${root}/built_backends.cpp ${names})

add_library(photongrid_renderer STATIC ${PROJECT_SOURCE_DIR}/backends/any/any.cpp ${root}/built_backends.cpp ${sources})
add_library(photongrid::renderer ALIAS photongrid_renderer)
set_target_properties(photongrid_renderer PROPERTIES EXPORT_NAME renderer POSITION_INDEPENDENT_CODE ON)
set(folder ${root}/photongrid/backends/any)
target_sources(photongrid_renderer PUBLIC FILE_SET HEADERS BASE_DIRS ${root} FILES ${folder}/any.hpp)
target_link_libraries(photongrid_renderer PUBLIC photongrid PRIVATE $<BUILD_INTERFACE:photongrid_warnings> ${libraries})
target_compile_options(photongrid_renderer PRIVATE -ffp-contract=off) # exact_begin.hpp
target_compile_definitions(photongrid_renderer PRIVATE PHOTONGRID_CONTRACTION_IS_OFF
  $<$<BOOL:${PHOTONGRID_TESTS}>:PHOTONGRID_COMPILES_ALGORITHMS>) # tests take its algorithms from it
if(NOT PROJECT_IS_TOP_LEVEL)
  set_target_properties(photongrid_renderer PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()
