# The OpenGL backend: OpenGL 4.5 core on EGL, and on OSMesa where that is installed. Functions are found at run time, so
# neither libGL nor a loader library is linked.
find_package(OpenGL COMPONENTS EGL QUIET GLOBAL)
find_path(PHOTONGRID_GLCOREARB_DIR GL/glcorearb.h)
mark_as_advanced(PHOTONGRID_GLCOREARB_DIR)
if(NOT TARGET OpenGL::EGL OR NOT PHOTONGRID_GLCOREARB_DIR)
  message(STATUS "photongrid: no EGL or OpenGL headers; the gl backend is off (Debian packages libegl-dev, libopengl-dev, libgl-dev)")
  set(PHOTONGRID_GL OFF)
  return()
endif()

file(GLOB gl_texts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/backends/gl/*.glsl ${PROJECT_SOURCE_DIR}/backends/gl/overrides/*.glsl)
list(APPEND gl_texts ${PROJECT_SOURCE_DIR}/include/photongrid/core/exact_arithmetic.glsl)
photongrid_backend(gl TEXTS ${gl_texts})
target_include_directories(photongrid_gl INTERFACE $<BUILD_INTERFACE:${PHOTONGRID_GLCOREARB_DIR}>)
target_link_libraries(photongrid_gl INTERFACE OpenGL::EGL)

find_package(PkgConfig QUIET)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(PHOTONGRID_OSMESA QUIET IMPORTED_TARGET GLOBAL osmesa)
endif()
if(NOT TARGET PkgConfig::PHOTONGRID_OSMESA)
  message(STATUS "photongrid: no OSMesa; the gl backend uses EGL only (Debian package libosmesa6-dev)")
endif()
# Asked again where the installed target is used: photongrid-config.cmake looks for OSMesa under the same name.
set(osmesa PkgConfig::PHOTONGRID_OSMESA)
target_compile_definitions(photongrid_gl INTERFACE $<$<TARGET_EXISTS:${osmesa}>:PHOTONGRID_HAS_OSMESA>)
target_link_libraries(photongrid_gl INTERFACE $<TARGET_NAME_IF_EXISTS:${osmesa}>)
