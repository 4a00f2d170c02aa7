# photongrid::backend_tests: what every backend promises, as tests for a backend of your own (docs/reference/backend.md). Read where
# GoogleTest, rapidcheck and FLANN were found, by tests/CMakeLists.txt.
file(GLOB verb_kernels CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/core/verbs/*.glsl)
set(verb_kernel_text ${CMAKE_CURRENT_BINARY_DIR}/generated/photongrid/backend_tests/verb_kernel_text.hpp)
photongrid_embed(OUTPUT ${verb_kernel_text} TABLE verb_kernel_texts BASE ${PROJECT_SOURCE_DIR} FILES ${verb_kernels})

# Its headers are <photongrid/backend_tests.hpp> and <photongrid/backend_tests/...>, here as where they are installed.
set(root ${PROJECT_BINARY_DIR}/backend_tests)
file(MAKE_DIRECTORY ${root}/photongrid)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/tests ${root}/photongrid/backend_tests SYMBOLIC)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/tests/backend_tests.hpp ${root}/photongrid/backend_tests.hpp SYMBOLIC)

add_library(photongrid_backend_tests INTERFACE)
add_library(photongrid::backend_tests ALIAS photongrid_backend_tests)
set_target_properties(photongrid_backend_tests PROPERTIES EXPORT_NAME backend_tests)
set(headers
  core/count_and_route_tests core/number_tests core/run_tests core/under_test core/verb_buffer_tests
  core/verb_kernels core/verb_tests core/verbs backends/serial_algorithms
  estimate/estimator_tests estimate/estimators estimate/exact_search_tests estimate/known_answers
  estimate/neighbour_tests estimate/policy_tests
  map/algorithm_tests map/algorithms map/block_map_tests map/buffer_tests map/hashed_route_tests map/map_file_tests
  map/photon_generator map/photon_sets map/route_tests map/search_tests map/sort_tests map/whole_map_tests)
list(TRANSFORM headers PREPEND ${root}/photongrid/backend_tests/)
list(TRANSFORM headers APPEND .hpp)
target_sources(photongrid_backend_tests INTERFACE FILE_SET HEADERS BASE_DIRS ${root} ${CMAKE_CURRENT_BINARY_DIR}/generated FILES ${root}/photongrid/backend_tests.hpp ${headers} ${verb_kernel_text})
# What the tests compare with is compiled once here, and by each user of the installed tests (cmake/install.cmake).
set(installed ${CMAKE_INSTALL_INCLUDEDIR}/photongrid/backend_tests)
target_sources(photongrid_backend_tests INTERFACE $<INSTALL_INTERFACE:${installed}/estimate/known_answers.cpp>
  $<INSTALL_INTERFACE:${installed}/backends/serial_algorithms.cpp>)
target_link_libraries(photongrid_backend_tests INTERFACE photongrid_serial $<BUILD_INTERFACE:test_references> rapidcheck flann::flann_cpp GTest::gtest_main)
