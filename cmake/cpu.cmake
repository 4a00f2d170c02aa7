# The cpu backend: threads by oneTBB, SIMD by Highway.
find_package(TBB QUIET GLOBAL COMPONENTS tbb)
find_package(hwy QUIET GLOBAL)
if(NOT TARGET TBB::tbb OR NOT TARGET hwy::hwy)
  message(STATUS "photongrid: no oneTBB or Highway; the cpu backend is off (Debian packages libtbb-dev, libhwy-dev)")
  set(PHOTONGRID_CPU OFF)
  return()
endif()

photongrid_backend(cpu)
target_link_libraries(photongrid_cpu INTERFACE TBB::tbb hwy::hwy)

# photongrid::cpu_compiled: the same backend and the same headers, with all that takes the compiler long in a library. Its
# users read nothing of oneTBB's or Highway's vector code that they need not, and may have vector code of their own.
# <photongrid/backends/cpu/compiled.hpp> is the shortest way to it.
add_library(photongrid_cpu_compiled STATIC ${PROJECT_SOURCE_DIR}/backends/cpu/compiled.cpp
  ${PROJECT_SOURCE_DIR}/backends/cpu/compiled_maps.cpp)
add_library(photongrid::cpu_compiled ALIAS photongrid_cpu_compiled)
set_target_properties(photongrid_cpu_compiled PROPERTIES EXPORT_NAME cpu_compiled OUTPUT_NAME photongrid_cpu
  POSITION_INDEPENDENT_CODE ON UNITY_BUILD OFF) # for two cores
if(NOT PROJECT_IS_TOP_LEVEL)
  set_target_properties(photongrid_cpu_compiled PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()
target_link_libraries(photongrid_cpu_compiled PUBLIC photongrid_cpu)
target_compile_definitions(photongrid_cpu_compiled PUBLIC PHOTONGRID_CPU_COMPILED
  # Machines with SSSE3 and no SSE4 (2006) run the baseline: one instruction set less to compile.
  PRIVATE PHOTONGRID_CONTRACTION_IS_OFF HWY_DISABLED_TARGETS=HWY_SSSE3)
target_compile_options(photongrid_cpu_compiled PRIVATE -ffp-contract=off # exact_begin.hpp
  ${photongrid_warm})
