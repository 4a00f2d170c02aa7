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
target_compile_options(photongrid_cpu INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-ffp-contract=off>)
