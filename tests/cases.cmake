# How test programs become tests of ctest. Each program is one test, run once without its long_ cases and, labelled
# "long", once with nothing else; what is labelled "full" only tests/run.sh --full runs. Each case is a test, too,
# called PROGRAM.SUITE.CASE and labelled "case" and by its folder: `ctest -R no_ray_escapes` runs it alone, and where
# its program runs as well, case.sh looks its result up instead of running it again.
include(GoogleTest)

# Whole scenes and the double oracle: a quick run under sanitizers leaves out what is labelled heavy (tests/run.sh).
set(heavy_cases *scene_files*:double_oracle*:routed_pictures*)
set(test_environment "RC_PARAMS=${PHOTONGRID_RC_PARAMS};XDG_CACHE_HOME=${PROJECT_BINARY_DIR}/tests/cache")

# ctest knows no times from before on a fresh machine: the longest programs first, s on two cores.
set(cost_on_vulkan 345)
set(cost_on_gl 207)
set(cost_viewer_window 72)
set(cost_vulkan_backend 56)
set(cost_on_gl_heavy 52)
set(cost_on_cpu 45)
set(cost_on_vulkan_heavy 35)
set(cost_gl_backend 40)
set(cost_host_caustics 34)

# photongrid_cases(PROGRAM TESTS FILTER LABEL...): those cases of the program that TESTS run, which FILTER chooses.
function(photongrid_cases program tests filter)
  list(GET tests 0 test)
  gtest_discover_tests(${program} TEST_PREFIX ${program}. TEST_LIST ${test}_cases TEST_FILTER ${filter}
    DISCOVERY_TIMEOUT 60)
  # Read by ctest after the list of cases.
  set(properties "LABELS \"case;${ARGN}\" DEPENDS \"${tests}\" TIMEOUT 3600 ENVIRONMENT \"${test_environment}\"")
  set(file ${CMAKE_CURRENT_BINARY_DIR}/${test}_cases.cmake)
  file(WRITE ${file}
    "if(${test}_cases)\n  set_tests_properties(\${${test}_cases} PROPERTIES ${properties})\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file})
endfunction()

# photongrid_run(PROGRAM [HEAVY_CASES] [LONG] [HEAVY] [SHARED_OUT] [FULL] [FULL_CASES pattern...]) runs a test program. Its
# heavy cases, its long ones, and those that only a full run runs, are tests of their own. A long run under sanitizers is
# SHARED_OUT among four that run side by side.
function(photongrid_run name)
  cmake_parse_arguments(arg "LONG;HEAVY_CASES;HEAVY;SHARED_OUT;FULL" "" "FULL_CASES" ${ARGN})
  list(JOIN arg_FULL_CASES : full_cases)
  set(others *long_*:${full_cases})
  set(launcher ${PROJECT_SOURCE_DIR}/tests/case.sh ${PROJECT_BINARY_DIR}/tests/logs/${name})
  set_target_properties(${name} PROPERTIES CROSSCOMPILING_EMULATOR "${launcher};${CMAKE_CROSSCOMPILING_EMULATOR}")
  get_filename_component(folder ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  # add(TEST FILTER TIMEOUT LABEL...): TEST runs those cases that FILTER chooses.
  macro(add test filter seconds)
    add_test(NAME ${test} COMMAND ${name} --gtest_filter=${filter})
    set_tests_properties(${test} PROPERTIES LABELS "${folder};${ARGN}" TIMEOUT ${seconds} ENVIRONMENT "${test_environment}")
    if(DEFINED cost_${test})
      set_tests_properties(${test} PROPERTIES COST ${cost_${test}})
    endif()
    set(runs ${test} ${shards})
    photongrid_cases(${name} "${runs}" ${filter} ${folder} ${ARGN})
  endmacro()
  set(shards)
  if(PHOTONGRID_SANITIZE AND arg_SHARED_OUT)
    foreach(number RANGE 1 3)
      set(shard ${name}_shard_${number})
      list(APPEND shards ${shard})
      add_test(NAME ${shard} COMMAND ${name} --gtest_filter=-${others}:${heavy_cases})
      set_tests_properties(${shard} PROPERTIES TIMEOUT 1200 COST 1000 # before the cases
        ENVIRONMENT "${test_environment};GTEST_TOTAL_SHARDS=4;GTEST_SHARD_INDEX=${number}")
    endforeach()
  endif()
  set(labels)
  foreach(kind HEAVY FULL)
    if(arg_${kind})
      string(TOLOWER ${kind} label)
      list(APPEND labels ${label})
    endif()
  endforeach()
  if(arg_FULL AND NOT PHOTONGRID_FULL_TESTS)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
  endif()
  add(${name} -${others}:${heavy_cases} 1200 ${labels})
  if(arg_HEAVY_CASES)
    add(${name}_heavy ${heavy_cases}:-${others} 1200 heavy ${labels})
  endif()
  if(full_cases)
    add(${name}_full ${full_cases}:-*long_* 1200 full)
  endif()
  if(arg_LONG)
    add(${name}_long *long_* 3600 long)
  endif()
  if(shards)
    set_tests_properties(${name} PROPERTIES ENVIRONMENT "${test_environment};GTEST_TOTAL_SHARDS=4;GTEST_SHARD_INDEX=0")
  endif()
endfunction()

# photongrid_only_in_full(test target): the test, and the target that it runs, are not worth a short run's time.
function(photongrid_only_in_full test target)
  set_property(TEST ${test} APPEND PROPERTY LABELS full)
  if(NOT PHOTONGRID_FULL_TESTS)
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL TRUE)
  endif()
endfunction()

# What a quick run under sanitizers builds.
add_custom_target(photongrid_quick_tests)

# photongrid_test(NAME [SOURCES file...] [LIBRARIES lib...] [PLAIN] [COMPILED] [SANITIZED | UNSANITIZED]
#   [what photongrid_run takes...])
# builds NAME.cpp, or SOURCES, and runs it. PLAIN: what it computes itself takes less time than optimizing it would.
# COMPILED: it reads no kernel of the library and takes the algorithms that photongrid::renderer has compiled.
# SANITIZED: a short run runs it under sanitizers alone, a full one also without. UNSANITIZED: the other way round.
function(photongrid_test name)
  cmake_parse_arguments(arg "LONG;HEAVY_CASES;HEAVY;SHARED_OUT;PLAIN;COMPILED;SANITIZED;UNSANITIZED" ""
    "SOURCES;LIBRARIES;FULL_CASES" ${ARGN})
  if(arg_UNSANITIZED AND PHOTONGRID_SANITIZE)
    set(arg_HEAVY TRUE)
  endif()
  if(NOT arg_SOURCES)
    set(arg_SOURCES ${name}.cpp)
  endif()
  add_executable(${name} ${arg_SOURCES})
  # Debian's rapidcheck and flann headers are not warning-free; SYSTEM is what find_package gives them.
  target_link_libraries(${name} PRIVATE photongrid_warnings ${arg_LIBRARIES} rapidcheck flann::flann_cpp GTest::gtest_main)
  if(arg_COMPILED)
    target_compile_definitions(${name} PRIVATE PHOTONGRID_KERNELS_ARE_COMPILED)
    target_link_libraries(${name} PRIVATE photongrid::renderer)
  endif()
  set(headers test_headers)
  if(arg_PLAIN AND NOT PHOTONGRID_SANITIZE)
    set(headers test_headers_plain)
    target_compile_options(${name} PRIVATE -O0)
  endif()
  if(PHOTONGRID_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Checks of large functions are calls: the same checks, a quarter less to compile.
    target_compile_options(${name} PRIVATE --param=asan-instrumentation-with-call-threshold=100)
  endif()
  target_precompile_headers(${name} REUSE_FROM ${headers})
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  if(photongrid::serial IN_LIST arg_LIBRARIES)
    target_link_libraries(${name} PRIVATE test_references)
  endif()
  set(kinds)
  foreach(kind LONG HEAVY_CASES HEAVY SHARED_OUT)
    if(arg_${kind})
      list(APPEND kinds ${kind})
    endif()
  endforeach()
  if(arg_SANITIZED AND NOT PHOTONGRID_SANITIZE)
    list(APPEND kinds FULL)
  endif()
  photongrid_run(${name} ${kinds} FULL_CASES ${arg_FULL_CASES})
  if(NOT arg_HEAVY)
    add_dependencies(photongrid_quick_tests ${name})
  endif()
endfunction()

# photongrid_tsan_test(NAME SOURCES file... LIBRARIES lib... [DEFINITIONS name...]): the test under the thread
# sanitizer, built when it runs, in a full run.
function(photongrid_tsan_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES;DEFINITIONS" ${ARGN})
  if(PHOTONGRID_SANITIZE)
    return()
  endif()
  add_executable(${name}_tsan EXCLUDE_FROM_ALL ${arg_SOURCES})
  target_link_libraries(${name}_tsan PRIVATE photongrid_warnings ${arg_LIBRARIES} GTest::gtest_main)
  target_compile_definitions(${name}_tsan PRIVATE ${arg_DEFINITIONS})
  target_compile_options(${name}_tsan PRIVATE -Og -g1 -fsanitize=thread)
  target_link_options(${name}_tsan PRIVATE -fsanitize=thread)
  add_test(NAME ${name}_tsan_build COMMAND ${CMAKE_COMMAND} --build ${PROJECT_BINARY_DIR} --target ${name}_tsan)
  add_test(NAME ${name}_tsan COMMAND ${name}_tsan)
  set_tests_properties(${name}_tsan_build PROPERTIES LABELS long FIXTURES_SETUP ${name}_tsan RUN_SERIAL TRUE)
  set_tests_properties(${name}_tsan PROPERTIES LABELS long TIMEOUT 1200 FIXTURES_REQUIRED ${name}_tsan
    ENVIRONMENT "TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/tsan.supp")
endfunction()
