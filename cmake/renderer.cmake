# photongrid::renderer: the renderer, compiled once for each backend that is built, which is chosen at run time. The
# program has the same, with all backends but one in modules, which need not be there and whose libraries may be broken.

# photongrid_built_backends(FILE [LINKED name...] [MODULES name...]): the source file that lists these backends to
# backends/any.
function(photongrid_built_backends file)
  cmake_parse_arguments(arg "" "" "LINKED;MODULES" ${ARGN})
  set(include backend_entry)
  set(entries "")
  foreach(name IN LISTS arg_LINKED)
    string(APPEND entries "        {\"${name}\", ${name}_entry},\n")
  endforeach()
  foreach(name IN LISTS arg_MODULES)
    string(APPEND entries "        {\"${name}\", [] { return entry_of_module(\"${name}\"); }},\n")
    set(include module)
  endforeach()
  file(CONFIGURE OUTPUT ${file} CONTENT [[
// The backends of this build: cmake/renderer.cmake.
#include <photongrid/backends/any/@include@.hpp>

std::span<const photongrid::any::built_backend> photongrid::any::built_backends()
{
    static constexpr built_backend all[] = {
@entries@    };
    return all;
}
]] @ONLY)
endfunction()

set(photongrid_any_root ${PROJECT_BINARY_DIR}/backends/any)
file(MAKE_DIRECTORY ${photongrid_any_root}/photongrid/backends)
set(any ${photongrid_any_root}/photongrid/backends/any)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/backends/any ${any} SYMBOLIC)

# What all of its files are compiled with.
add_library(photongrid_any INTERFACE)
target_include_directories(photongrid_any INTERFACE ${photongrid_any_root})
target_link_libraries(photongrid_any INTERFACE photongrid photongrid_warnings)
target_compile_options(photongrid_any INTERFACE -ffp-contract=off) # exact_begin.hpp
target_compile_definitions(photongrid_any INTERFACE PHOTONGRID_CONTRACTION_IS_OFF
  $<$<BOOL:${PHOTONGRID_TESTS}>:PHOTONGRID_COMPILES_ALGORITHMS>) # tests take its algorithms from it

# photongrid_renderer_on_NAME: the renderer on a backend, for the library and for the program's module alike.
set(photongrid_renderer_backends "")
set(objects "")
set(libraries "")
foreach(name IN ITEMS serial cpu gl vulkan)
  if(TARGET photongrid::${name})
    set(library photongrid_${name})
    if(TARGET photongrid_${name}_compiled)
      set(library photongrid_${name}_compiled)
    endif()
    add_library(photongrid_renderer_on_${name} OBJECT EXCLUDE_FROM_ALL ${any}/${name}.cpp)
    set_target_properties(photongrid_renderer_on_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(photongrid_renderer_on_${name} PRIVATE photongrid_any PUBLIC ${library})
    list(APPEND photongrid_renderer_backends ${name})
    list(APPEND objects $<TARGET_OBJECTS:photongrid_renderer_on_${name}>)
    list(APPEND libraries ${library})
  endif()
endforeach()

photongrid_built_backends(${photongrid_any_root}/built_backends.cpp LINKED ${photongrid_renderer_backends})
add_library(photongrid_renderer STATIC ${any}/any.cpp ${any}/limits.cpp ${any}/speed.cpp ${photongrid_any_root}/built_backends.cpp ${objects})
add_library(photongrid::renderer ALIAS photongrid_renderer)
set_target_properties(photongrid_renderer PROPERTIES EXPORT_NAME renderer POSITION_INDEPENDENT_CODE ON)
target_sources(photongrid_renderer PUBLIC FILE_SET HEADERS BASE_DIRS ${photongrid_any_root} FILES ${any}/any.hpp)
target_link_libraries(photongrid_renderer PUBLIC photongrid PRIVATE $<BUILD_INTERFACE:photongrid_any> ${libraries})
if(NOT PROJECT_IS_TOP_LEVEL)
  set_target_properties(photongrid_renderer PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()

# photongrid_module(NAME SOURCE...): the target photongrid_module_NAME, which the program loads as NAME.so from its
# folder of modules (backends/any/module.hpp). The program is built without it, so that the first picture need not wait
# for what it does not use.
add_custom_target(photongrid_modules)
set(photongrid_modules_folder ${PROJECT_BINARY_DIR}/photongrid-modules)
file(MAKE_DIRECTORY ${photongrid_modules_folder}) # by which a program knows that it lies where it was built
function(photongrid_module name)
  add_library(photongrid_module_${name} MODULE ${ARGN})
  set_target_properties(photongrid_module_${name} PROPERTIES OUTPUT_NAME ${name} PREFIX ""
    LIBRARY_OUTPUT_DIRECTORY ${photongrid_modules_folder})
  target_link_libraries(photongrid_module_${name} PRIVATE photongrid_any)
  set_property(GLOBAL APPEND PROPERTY photongrid_modules photongrid_module_${name})
  add_dependencies(photongrid_modules photongrid_module_${name})
endfunction()

# photongrid_program_renderer(): the target of that name, with one backend linked, cpu if it is built, and the others in
# modules. The program lists those too whose libraries CMake did not find, so that it is the same program when they come.
# PHOTONGRID_MODULES: the folder of installed modules, relative to the program's.
function(photongrid_program_renderer)
  set(root ${photongrid_any_root})
  set(any ${root}/photongrid/backends/any)
  set(linked serial)
  if("cpu" IN_LIST photongrid_renderer_backends)
    set(linked cpu)
  endif()
  set(modules ${photongrid_renderer_backends})
  list(REMOVE_ITEM modules ${linked})
  set(listed ${modules})
  foreach(name IN ITEMS gl vulkan)
    string(TOUPPER ${name} option)
    if($CACHE{PHOTONGRID_${option}})
      list(APPEND listed ${name})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES listed)
  photongrid_built_backends(${root}/program_backends.cpp LINKED ${linked} MODULES ${listed})
  add_library(photongrid_program_renderer STATIC ${any}/any.cpp ${any}/limits.cpp ${any}/speed.cpp ${any}/module.cpp ${root}/program_backends.cpp)
  target_include_directories(photongrid_program_renderer PUBLIC ${root})
  target_compile_definitions(photongrid_program_renderer PRIVATE PHOTONGRID_MODULES="${PHOTONGRID_MODULES}")
  target_link_libraries(photongrid_program_renderer PUBLIC photongrid
    PRIVATE photongrid_any ${CMAKE_DL_LIBS} photongrid_renderer_on_${linked})
  foreach(name IN LISTS modules)
    file(CONFIGURE OUTPUT ${root}/module_${name}.cpp CONTENT [[
// The module of a backend: cmake/renderer.cmake.
#include <photongrid/backends/any/module.hpp>

PHOTONGRID_MODULE

extern "C" const photongrid::any::backend_entry* photongrid_backend_entry()
{
    static const auto entry = photongrid::any::@name@_entry();
    return &entry;
}
]] @ONLY)
    photongrid_module(${name} ${root}/module_${name}.cpp ${any}/limits.cpp)
    target_link_libraries(photongrid_module_${name} PRIVATE photongrid_renderer_on_${name})
  endforeach()
endfunction()
