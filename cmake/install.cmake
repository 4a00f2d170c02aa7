# What is installed, in two components: `dev`, the headers with CMake's and pkg-config's files, none of which depends on the
# processor, and `program`. CPack makes a Debian package of each: cpack -G DEB.
include(CMakePackageConfigHelpers)

# --- dev: headers, find_package ---------------------------------------------------------------------------------------
set(config_dir ${CMAKE_INSTALL_DATADIR}/cmake/photongrid)
# A file of targets for the core and for each component, so that find_package defines what was asked for and nothing else.
set(photongrid_components "")
install(TARGETS photongrid EXPORT photongrid-core FILE_SET HEADERS COMPONENT dev)
install(EXPORT photongrid-core NAMESPACE photongrid:: DESTINATION ${config_dir} COMPONENT dev)
foreach(component IN ITEMS serial cpu gl vulkan backend_tests)
  if(TARGET photongrid_${component})
    list(APPEND photongrid_components ${component})
    install(TARGETS photongrid_${component} EXPORT photongrid-${component} FILE_SET HEADERS COMPONENT dev)
    install(EXPORT photongrid-${component} NAMESPACE photongrid:: DESTINATION ${config_dir} COMPONENT dev)
  endif()
endforeach()
# Kernels are headers to C++ too, kernels/begin.hpp and end.hpp are to those who write their own.
install(DIRECTORY include/photongrid/kernels DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/photongrid COMPONENT dev)
if(TARGET photongrid_gl)
  install(DIRECTORY backends/gl/overrides DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/photongrid/backends/gl COMPONENT dev FILES_MATCHING PATTERN "*.glsl")
endif()
if(TARGET photongrid_backend_tests)
  set(folder ${CMAKE_INSTALL_INCLUDEDIR}/photongrid/backend_tests)
  install(DIRECTORY tests/kernels/verbs DESTINATION ${folder}/kernels COMPONENT dev)
  install(FILES tests/known_answers.cpp tests/serial_algorithms.cpp DESTINATION ${folder} COMPONENT dev)
endif()
configure_package_config_file(cmake/photongrid-config.cmake.in ${PROJECT_BINARY_DIR}/photongrid-config.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/photongrid-config-version.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/photongrid-config.cmake ${PROJECT_BINARY_DIR}/photongrid-config-version.cmake DESTINATION ${config_dir} COMPONENT dev)
install(FILES cmake/embed.cmake cmake/add_kernels.cmake DESTINATION ${config_dir} COMPONENT dev)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/photongrid-dev RENAME copyright COMPONENT dev)

# --- dev: pkg-config --------------------------------------------------------------------------------------------------
set(pkg_config_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)
file(RELATIVE_PATH to_prefix /prefix/${pkg_config_dir} /prefix)
string(REGEX REPLACE "/$" "" to_prefix ${to_prefix})

# photongrid_pkg_config(NAME DESCRIPTION [REQUIRES text] [CFLAGS text] [LIBS text]): the file NAME.pc, which finds its headers
# by where it lies itself.
function(photongrid_pkg_config name description)
  cmake_parse_arguments(arg "" "REQUIRES;CFLAGS;LIBS" "" ${ARGN})
  configure_file(cmake/photongrid.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${pkg_config_dir} COMPONENT dev)
endfunction()

photongrid_pkg_config(photongrid "${PROJECT_DESCRIPTION}" REQUIRES glm CFLAGS "-I\${includedir}")
photongrid_pkg_config(photongrid-serial "photongrid on one thread, the specification" REQUIRES photongrid CFLAGS -ffp-contract=off)
if(TARGET photongrid_cpu)
  photongrid_pkg_config(photongrid-cpu "photongrid on threads and SIMD" REQUIRES "photongrid, tbb, libhwy" CFLAGS -ffp-contract=off)
endif()
if(TARGET photongrid_gl)
  photongrid_pkg_config(photongrid-gl "photongrid on OpenGL, by EGL" REQUIRES "photongrid, egl")
  photongrid_pkg_config(photongrid-gl-osmesa "photongrid on OpenGL, by EGL or OSMesa" REQUIRES "photongrid-gl, osmesa" CFLAGS -DPHOTONGRID_HAS_OSMESA)
endif()
if(TARGET photongrid_vulkan)
  photongrid_pkg_config(photongrid-vulkan "photongrid on Vulkan" REQUIRES "photongrid, vulkan, spirv" CFLAGS -pthread LIBS "-lglslang-default-resource-limits -pthread")
endif()

# --- program ----------------------------------------------------------------------------------------------------------
if(TARGET photongrid_program)
  install(TARGETS photongrid_program RUNTIME COMPONENT program)
  install(DIRECTORY examples/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/photongrid COMPONENT program FILES_MATCHING PATTERN "*.json")
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/photongrid RENAME copyright COMPONENT program)
endif()

# --- Debian packages --------------------------------------------------------------------------------------------------
if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_CONTACT "photongrid authors")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_STRIP_FILES ON)

  set(CPACK_COMPONENTS_ALL dev)
  set(CPACK_COMPONENT_DEV_DESCRIPTION "${PROJECT_DESCRIPTION}: headers")
  set(CPACK_DEBIAN_DEV_PACKAGE_NAME photongrid-dev)
  set(CPACK_DEBIAN_DEV_PACKAGE_ARCHITECTURE all)
  set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS libglm-dev)
  set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "libtbb-dev, libhwy-dev, libegl-dev, libopengl-dev, libgl-dev, libosmesa6-dev, libvulkan-dev, glslang-dev, glslang-tools, spirv-tools, libgtest-dev, librapidcheck-dev, libflann-dev")

  if(TARGET photongrid_program)
    list(APPEND CPACK_COMPONENTS_ALL program)
    set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "${PROJECT_DESCRIPTION}: the renderer")
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME photongrid)
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "mesa-vulkan-drivers, libegl-mesa0, libgl1-mesa-dri")
  endif()
  include(CPack)
endif()
