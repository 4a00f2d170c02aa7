# photongrid::backend_tests: what every backend promises, as tests for a backend of your own (docs/backend.md). Read where
# GoogleTest, rapidcheck and FLANN were found, by tests/CMakeLists.txt.
file(GLOB verb_kernels CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/kernels/verbs/*.glsl)
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
target_include_directories(photongrid_backend_tests INTERFACE $<BUILD_INTERFACE:${root}> $<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}/generated>)
# What the tests compare with is compiled once here, and once by each user.
set(installed ${CMAKE_INSTALL_INCLUDEDIR}/photongrid/backend_tests)
set(references known_answers.cpp serial_algorithms.cpp)
foreach(file IN LISTS references)
  target_sources(photongrid_backend_tests INTERFACE $<INSTALL_INTERFACE:${installed}/${file}>)
endforeach()
target_link_libraries(photongrid_backend_tests INTERFACE photongrid_serial $<BUILD_INTERFACE:test_references> rapidcheck flann::flann_cpp GTest::gtest_main)

# A file of its own, so that the package asks for these libraries only where the component is wanted and was built.
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/photongrid)
install(TARGETS photongrid_backend_tests EXPORT photongrid-backend-tests)
install(EXPORT photongrid-backend-tests NAMESPACE photongrid:: DESTINATION ${config_dir} FILE photongrid-backend-tests-targets.cmake)
install(FILES backend_tests.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/photongrid)
install(FILES algorithm_tests.hpp estimator_tests.hpp known_answers.hpp map_file_tests.hpp neighbour_tests.hpp number_tests.hpp photon_sets.hpp serial_algorithms.hpp test_scenes.hpp under_test.hpp
  verb_kernels.hpp verb_tests.hpp ${verb_kernel_text} ${references} DESTINATION ${installed})
install(DIRECTORY kernels/verbs DESTINATION ${installed}/kernels)
