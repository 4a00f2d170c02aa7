# photongrid::io: scene files and pictures. Its headers name none of the libraries it is made with.
find_package(nlohmann_json QUIET)
find_package(OpenEXR QUIET)
find_package(PNG QUIET)
find_package(ZLIB QUIET)
find_package(pugixml QUIET)
find_path(PHOTONGRID_STB_INCLUDE_DIR stb/stb_image.h)
mark_as_advanced(PHOTONGRID_STB_INCLUDE_DIR)
if(NOT TARGET nlohmann_json::nlohmann_json OR NOT TARGET OpenEXR::OpenEXR OR NOT TARGET PNG::PNG OR NOT TARGET ZLIB::ZLIB
    OR NOT TARGET pugixml::pugixml OR NOT PHOTONGRID_STB_INCLUDE_DIR)
  message(STATUS "photongrid: no scene files or pictures, and no program (Debian packages nlohmann-json3-dev, libopenexr-dev, libpng-dev, libpugixml-dev, libstb-dev, zlib1g-dev)")
  return()
endif()
file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/photongrid/io/*.cpp
  ${PROJECT_SOURCE_DIR}/include/photongrid/io/*/*.cpp)
add_library(photongrid_io STATIC ${sources})
add_library(photongrid::io ALIAS photongrid_io)
set_target_properties(photongrid_io PROPERTIES EXPORT_NAME io POSITION_INDEPENDENT_CODE ON)
set(folder ${PROJECT_SOURCE_DIR}/include/photongrid/io)
target_sources(photongrid_io PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include
  FILES ${folder}/error_map.hpp ${folder}/error_sheet.hpp ${folder}/exported_scene.hpp ${folder}/false_colors.hpp
  ${folder}/files.hpp ${folder}/flip.hpp ${folder}/gltf_file.hpp ${folder}/gltf_writer.hpp
  ${folder}/image_difference.hpp ${folder}/image_file.hpp ${folder}/imported_scene.hpp ${folder}/mitsuba_file.hpp
  ${folder}/obj_scene.hpp ${folder}/pbrt_file.hpp ${folder}/pbrt_writer.hpp ${folder}/picture_noise.hpp
  ${folder}/picture_regions.hpp ${folder}/scene_edit.hpp ${folder}/scene_error.hpp ${folder}/scene_export.hpp ${folder}/scene_file.hpp
  ${folder}/scene_import.hpp ${folder}/scene_writer.hpp ${folder}/structural_similarity.hpp ${folder}/tone_map.hpp)
target_link_libraries(photongrid_io PUBLIC photongrid PRIVATE $<BUILD_INTERFACE:photongrid_warnings>
  $<BUILD_INTERFACE:nlohmann_json::nlohmann_json> OpenEXR::OpenEXR PNG::PNG ZLIB::ZLIB pugixml::pugixml)
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
