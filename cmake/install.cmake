# What is installed, in components: `dev`, the headers with CMake's and pkg-config's files, none of which depends on the
# processor; `compiled`, the libraries that spare their users compiling them; `program`; and one for each of its modules
# that needs libraries of its own: `gl`, `vulkan`, `window`. CPack makes a Debian package of each: cpack -G DEB.
#
# examples/run.sh builds a part of this. What is not built is not installed, with a line that says so; cpack builds it
# first.
include(CMakePackageConfigHelpers)
add_custom_target(photongrid_installed) # all that can be installed

# photongrid_install_if_built(TARGET COMPONENT name [FILES file... DESTINATION folder]): says at installation that
# TARGET is left out where it is not built, and installs FILES, which tell of it, where it is.
function(photongrid_install_if_built target)
  cmake_parse_arguments(arg "" "COMPONENT;DESTINATION" "FILES" ${ARGN})
  add_dependencies(photongrid_installed ${target})
  set(then "")
  set(how "cmake --build ${PROJECT_BINARY_DIR} --target photongrid_installed builds all")
  if(arg_FILES)
    set(then
      "file(INSTALL DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${arg_DESTINATION}\" TYPE FILE FILES \"${arg_FILES}\")")
  endif()
  install(CODE "if(EXISTS \"$<TARGET_FILE:${target}>\")
    ${then}
  else()
    message(STATUS \"Left out: $<TARGET_FILE_NAME:${target}>, which is not built; ${how}\")
  endif()" COMPONENT ${arg_COMPONENT})
endfunction()

# --- dev: headers, find_package ---------------------------------------------------------------------------------------
set(config_dir ${CMAKE_INSTALL_DATADIR}/cmake/photongrid)
# A file of targets for the core and for each component, so that find_package defines what was asked for and nothing else.
set(photongrid_components "")
install(TARGETS photongrid EXPORT photongrid-core FILE_SET HEADERS COMPONENT dev FILE_SET kernels COMPONENT dev)
install(EXPORT photongrid-core NAMESPACE photongrid:: DESTINATION ${config_dir} COMPONENT dev)
foreach(component IN ITEMS serial cpu cpu_compiled gl vulkan renderer io backend_tests)
  if(TARGET photongrid_${component})
    list(APPEND photongrid_components ${component})
    set(part dev)
    if(component MATCHES "^(cpu_compiled|renderer|io)$")
      set(part compiled)
      install(TARGETS photongrid_${component} EXPORT photongrid-${component} ARCHIVE COMPONENT ${part} OPTIONAL FILE_SET HEADERS COMPONENT ${part})
    else()
      install(TARGETS photongrid_${component} EXPORT photongrid-${component} FILE_SET HEADERS COMPONENT ${part})
    endif()
    install(EXPORT photongrid-${component} NAMESPACE photongrid:: DESTINATION ${config_dir} COMPONENT ${part})
  endif()
endforeach()
# Kernels are headers to C++ too; begin.hpp and end.hpp are for those who write their own.
install(DIRECTORY include/photongrid DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev FILES_MATCHING PATTERN "*.glsl" PATTERN "begin.hpp" PATTERN "end.hpp" PATTERN "exact_*.hpp")
if(TARGET photongrid_gl)
  install(DIRECTORY backends/gl/overrides DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/photongrid/backends/gl COMPONENT dev FILES_MATCHING PATTERN "*.glsl")
endif()
if(TARGET photongrid_backend_tests)
  set(folder ${CMAKE_INSTALL_INCLUDEDIR}/photongrid/backend_tests)
  install(DIRECTORY tests/core/verbs DESTINATION ${folder}/core COMPONENT dev)
  install(FILES tests/estimate/known_answers.cpp DESTINATION ${folder}/estimate COMPONENT dev)
  install(FILES tests/backends/serial_algorithms.cpp DESTINATION ${folder}/backends COMPONENT dev)
endif()
configure_package_config_file(cmake/photongrid-config.cmake.in ${PROJECT_BINARY_DIR}/photongrid-config.cmake
  INSTALL_DESTINATION ${config_dir} PATH_VARS CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/photongrid-config-version.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/photongrid-config.cmake ${PROJECT_BINARY_DIR}/photongrid-config-version.cmake DESTINATION ${config_dir} COMPONENT dev)
install(FILES cmake/embed.cmake cmake/kernel_headers.cmake cmake/add_kernels.cmake DESTINATION ${config_dir} COMPONENT dev)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/photongrid-dev RENAME copyright COMPONENT dev)

# --- dev: pkg-config --------------------------------------------------------------------------------------------------
set(pkg_config_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)
file(RELATIVE_PATH to_prefix /prefix/${pkg_config_dir} /prefix)
string(REGEX REPLACE "/$" "" to_prefix ${to_prefix})

# photongrid_pkg_config(NAME DESCRIPTION [REQUIRES text] [CFLAGS text] [LIBS text] [OF target]): the file NAME.pc, which
# finds its headers by where it lies itself. OF: that of a compiled component, installed where TARGET is built.
function(photongrid_pkg_config name description)
  cmake_parse_arguments(arg "" "REQUIRES;CFLAGS;LIBS;OF" "" ${ARGN})
  configure_file(cmake/photongrid.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  if(arg_OF)
    photongrid_install_if_built(${arg_OF} COMPONENT compiled FILES ${PROJECT_BINARY_DIR}/${name}.pc
      DESTINATION ${pkg_config_dir})
  else()
    install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${pkg_config_dir} COMPONENT dev)
  endif()
endfunction()

# From a .pc file to the library of a compiled component.
file(RELATIVE_PATH to_library ${CMAKE_INSTALL_FULL_DATADIR}/pkgconfig ${CMAKE_INSTALL_FULL_LIBDIR})
photongrid_pkg_config(photongrid "${PROJECT_DESCRIPTION}" REQUIRES glm CFLAGS "-I\${includedir}")
photongrid_pkg_config(photongrid-serial "photongrid on one thread, the specification" REQUIRES photongrid)
if(TARGET photongrid_cpu)
  photongrid_pkg_config(photongrid-cpu "photongrid on threads and SIMD" REQUIRES "photongrid, tbb, libhwy")
endif()
if(TARGET photongrid_cpu_compiled)
  photongrid_pkg_config(photongrid-cpu_compiled "photongrid on threads and SIMD, compiled" REQUIRES "photongrid-cpu" CFLAGS -DPHOTONGRID_CPU_COMPILED
    LIBS "-L\${pcfiledir}/${to_library} -lphotongrid_cpu -ltbb -lhwy" OF photongrid_cpu_compiled)
endif()
if(TARGET photongrid_gl)
  photongrid_pkg_config(photongrid-gl "photongrid on OpenGL, by EGL" REQUIRES "photongrid, egl")
  photongrid_pkg_config(photongrid-gl-osmesa "photongrid on OpenGL, by EGL or OSMesa" REQUIRES "photongrid-gl, osmesa" CFLAGS -DPHOTONGRID_HAS_OSMESA)
endif()
if(TARGET photongrid_vulkan)
  photongrid_pkg_config(photongrid-vulkan "photongrid on Vulkan" REQUIRES "photongrid, vulkan, spirv" CFLAGS -pthread LIBS "-lglslang-default-resource-limits -pthread")
endif()

set(backends photongrid-serial)
foreach(name IN ITEMS cpu_compiled gl-osmesa vulkan)
  string(REGEX REPLACE "-.*" "" target ${name})
  if(TARGET photongrid_${target})
    list(APPEND backends photongrid-${name})
  endif()
endforeach()
if(TARGET photongrid_gl AND NOT TARGET PkgConfig::PHOTONGRID_OSMESA)
  list(TRANSFORM backends REPLACE "-osmesa$" "")
endif()
list(JOIN backends ", " backends)
photongrid_pkg_config(photongrid-renderer "photongrid's renderer on a backend chosen at run time" REQUIRES "${backends}"
  LIBS "-L\${pcfiledir}/${to_library} -lphotongrid_renderer" OF photongrid_renderer)
if(TARGET photongrid_io)
  photongrid_pkg_config(photongrid-io "photongrid's scene files and pictures" REQUIRES "photongrid, OpenEXR, libjpeg, libpng, pugixml, zlib"
    LIBS "-L\${pcfiledir}/${to_library} -lphotongrid_io" OF photongrid_io)
endif()

install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/photongrid-compiled-dev RENAME copyright COMPONENT compiled)

# --- program ----------------------------------------------------------------------------------------------------------
if(TARGET photongrid_program)
  install(TARGETS photongrid_program RUNTIME COMPONENT program OPTIONAL)
  photongrid_install_if_built(photongrid_program COMPONENT program)
  get_property(modules GLOBAL PROPERTY photongrid_modules)
  set(photongrid_module_parts "")
  foreach(module IN LISTS modules)
    string(REGEX REPLACE "^photongrid_module_" "" part ${module})
    if(part STREQUAL serial) # it needs nothing
      set(part program)
    else()
      list(APPEND photongrid_module_parts ${part})
    endif()
    install(TARGETS ${module} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/photongrid COMPONENT ${part} OPTIONAL)
    photongrid_install_if_built(${module} COMPONENT ${part})
  endforeach()
  install(DIRECTORY examples/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/photongrid COMPONENT program
    FILES_MATCHING PATTERN "*.json" PATTERN "*.ply" PATTERN "*.png" PATTERN "*.hdr"
      PATTERN "*.gltf" PATTERN "*.bin" PATTERN "*.obj" PATTERN "*.mtl" PATTERN "*.pbrt" PATTERN "*.xml")
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/photongrid RENAME copyright COMPONENT program)
endif()

# --- Debian packages --------------------------------------------------------------------------------------------------
if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_CONTACT "photongrid authors <photongrid@localhost>") # dpkg wants an address; there is no list of ours
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_STRIP_FILES ON)
  # Packages are whole: what examples/run.sh has not built is built first.
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/photongrid-build-packaged.cmake CONTENT [[
message(STATUS "photongrid: building what is not built yet of the packages' contents")
execute_process(COMMAND "@CMAKE_COMMAND@" --build "@PROJECT_BINARY_DIR@" --target photongrid_installed COMMAND_ERROR_IS_FATAL ANY)
]] @ONLY)
  set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_BINARY_DIR}/photongrid-build-packaged.cmake)

  set(CPACK_COMPONENTS_ALL dev)
  set(CPACK_COMPONENT_DEV_DESCRIPTION "${PROJECT_DESCRIPTION}: headers")
  set(CPACK_DEBIAN_DEV_PACKAGE_NAME photongrid-dev)
  set(CPACK_DEBIAN_DEV_PACKAGE_ARCHITECTURE all)
  set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS libglm-dev)
  set(of_vulkan "libvulkan-dev, glslang-dev, glslang-tools, spirv-tools")
  set(of_gl "libegl-dev, libopengl-dev, libgl-dev")
  set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "libtbb-dev, libhwy-dev, ${of_gl}, libosmesa6-dev, ${of_vulkan}, libgtest-dev, librapidcheck-dev, libflann-dev")

  # Its libraries are static: the packages of what they are made with are needed to link them.
  list(APPEND CPACK_COMPONENTS_ALL compiled)
  set(CPACK_COMPONENT_COMPILED_DESCRIPTION "${PROJECT_DESCRIPTION}: compiled libraries")
  set(CPACK_DEBIAN_COMPILED_PACKAGE_NAME photongrid-compiled-dev)
  set(CPACK_DEBIAN_COMPILED_PACKAGE_SECTION libdevel)
  set(depends "photongrid-dev (= ${PROJECT_VERSION})")
  if(TARGET photongrid_cpu_compiled)
    string(APPEND depends ", libtbb-dev, libhwy-dev")
  endif()
  set(CPACK_DEBIAN_COMPILED_PACKAGE_DEPENDS "${depends}")
  set(recommends "")
  if(TARGET photongrid_io)
    list(APPEND recommends "libjpeg-dev, libopenexr-dev, libpng-dev, libpugixml-dev, zlib1g-dev")
  endif()
  foreach(name IN ITEMS gl vulkan) # of the renderer
    if(TARGET photongrid_${name})
      list(APPEND recommends "${of_${name}}")
    endif()
  endforeach()
  if(TARGET PkgConfig::PHOTONGRID_OSMESA)
    list(APPEND recommends libosmesa6-dev)
  endif()
  list(JOIN recommends ", " CPACK_DEBIAN_COMPILED_PACKAGE_RECOMMENDS)

  if(TARGET photongrid_program)
    list(APPEND CPACK_COMPONENTS_ALL program)
    set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "${PROJECT_DESCRIPTION}: the renderer")
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME photongrid)
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
    # The program runs without its modules, so it does not depend on their libraries.
    list(TRANSFORM photongrid_module_parts PREPEND photongrid- OUTPUT_VARIABLE recommends)
    list(JOIN recommends ", " CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS)
    foreach(part IN LISTS photongrid_module_parts)
      list(APPEND CPACK_COMPONENTS_ALL ${part})
      string(TOUPPER ${part} PART)
      set(CPACK_COMPONENT_${PART}_DESCRIPTION "${PROJECT_DESCRIPTION}: the renderer's module ${part}")
      set(CPACK_DEBIAN_${PART}_PACKAGE_NAME photongrid-${part})
      set(CPACK_DEBIAN_${PART}_PACKAGE_SECTION graphics)
      set(CPACK_DEBIAN_${PART}_PACKAGE_SHLIBDEPS ON)
      set(CPACK_DEBIAN_${PART}_PACKAGE_DEPENDS "photongrid (= ${PROJECT_VERSION})")
    endforeach()
    set(CPACK_DEBIAN_GL_PACKAGE_RECOMMENDS "libegl-mesa0, libgl1-mesa-dri")
    set(CPACK_DEBIAN_VULKAN_PACKAGE_RECOMMENDS mesa-vulkan-drivers)
  endif()
  include(CPack)
endif()
