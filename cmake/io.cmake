# photongrid::io: scene files and pictures. Its headers name none of the libraries it is made with.
find_package(nlohmann_json QUIET)
find_package(OpenEXR QUIET)
find_package(JPEG QUIET)
find_package(PNG QUIET)
find_package(ZLIB QUIET)
find_package(pugixml QUIET)
find_path(PHOTONGRID_STB_INCLUDE_DIR stb/stb_image.h)
mark_as_advanced(PHOTONGRID_STB_INCLUDE_DIR)
if(NOT TARGET nlohmann_json::nlohmann_json OR NOT TARGET OpenEXR::OpenEXR OR NOT TARGET PNG::PNG OR NOT TARGET JPEG::JPEG OR NOT TARGET ZLIB::ZLIB
    OR NOT TARGET pugixml::pugixml OR NOT PHOTONGRID_STB_INCLUDE_DIR)
  message(STATUS "photongrid: no scene files or pictures, and no program (Debian packages nlohmann-json3-dev, libjpeg-dev, libopenexr-dev, libpng-dev, libpugixml-dev, libstb-dev, zlib1g-dev)")
  return()
endif()
# Headers of examples/photongrid are <photongrid/io/...> and <photongrid/compare/...>, here as where they are installed.
set(photongrid_io_root ${PROJECT_BINARY_DIR}/examples_include)
file(MAKE_DIRECTORY ${photongrid_io_root}/photongrid)
foreach(folder IN ITEMS io compare)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/examples/photongrid/${folder} ${photongrid_io_root}/photongrid/${folder} SYMBOLIC)
endforeach()
set(folder ${photongrid_io_root}/photongrid/io)
file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/photongrid/io/*.cpp
  ${PROJECT_SOURCE_DIR}/examples/photongrid/io/*/*.cpp)
add_library(photongrid_io STATIC ${sources})
add_library(photongrid::io ALIAS photongrid_io)
set_target_properties(photongrid_io PROPERTIES EXPORT_NAME io POSITION_INDEPENDENT_CODE ON)
# What a host needs; the other headers are the library's own.
target_sources(photongrid_io PUBLIC FILE_SET HEADERS BASE_DIRS ${photongrid_io_root}
  FILES ${folder}/exported_scene.hpp ${folder}/files.hpp ${folder}/image_file.hpp ${folder}/imported_scene.hpp
  ${folder}/scene_edit.hpp ${folder}/scene_error.hpp ${folder}/scene_export.hpp ${folder}/scene_file.hpp
  ${folder}/scene_import.hpp ${folder}/scene_writer.hpp ${folder}/tone_map.hpp)
target_link_libraries(photongrid_io PUBLIC photongrid PRIVATE $<BUILD_INTERFACE:photongrid_warnings>
  $<BUILD_INTERFACE:nlohmann_json::nlohmann_json> OpenEXR::OpenEXR JPEG::JPEG PNG::PNG ZLIB::ZLIB pugixml::pugixml)
target_compile_options(photongrid_io PRIVATE ${photongrid_warm})
target_include_directories(photongrid_io SYSTEM PRIVATE $<BUILD_INTERFACE:${PHOTONGRID_STB_INCLUDE_DIR}>)
if(PHOTONGRID_SANITIZE)
  set(together 0) # all
  if(PHOTONGRID_FUZZ)
    set(together 8) # in two: one for each core, since little else is compiled
  endif()
  set_target_properties(photongrid_io PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${together})
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
    target_compile_options(photongrid_io PRIVATE -fsanitize=fuzzer-no-link) # the fuzzer sees what its inputs execute
  endif()
endif()
if(NOT PROJECT_IS_TOP_LEVEL)
  set_target_properties(photongrid_io PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()

# Errors of pictures: for the program, its window and the tests; not installed.
file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/photongrid/compare/*.cpp)
add_library(photongrid_compare STATIC EXCLUDE_FROM_ALL ${sources})
set_target_properties(photongrid_compare PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(photongrid_compare PUBLIC photongrid_io PRIVATE photongrid_warnings)
