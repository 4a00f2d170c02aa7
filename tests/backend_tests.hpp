// The tests that every backend passes, for one of your own: link photongrid::backend_tests and write, in one source
// file and outside any namespace,
//
//   PHOTONGRID_TEST_BACKEND(mine, my_backend, my_backend(my_options{}))
//
// docs/reference/backend.md says what they ask.
#pragma once

#include <photongrid/backend_tests/core/number_tests.hpp>
#include <photongrid/backend_tests/core/verb_tests.hpp>
#include <photongrid/backend_tests/estimate/estimator_tests.hpp>
#include <photongrid/backend_tests/estimate/neighbour_tests.hpp>
#include <photongrid/backend_tests/map/algorithm_tests.hpp>
#include <photongrid/backend_tests/map/map_file_tests.hpp>

/// Runs all suites on the backend TYPE, of which the rest, an expression, makes one; tests are called NAME/...
#define PHOTONGRID_TEST_BACKEND(NAME, TYPE, ...)                                                                       \
    namespace photongrid::testing {                                                                                    \
    struct NAME##_tag {                                                                                                \
        using type = TYPE;                                                                                             \
        static constexpr const char* name = #NAME;                                                                     \
        static std::unique_ptr<type> make() { return std::unique_ptr<type>(new type(__VA_ARGS__)); }                   \
    };                                                                                                                 \
    }                                                                                                                  \
    PHOTONGRID_TEST_BACKEND_AS(NAME, photongrid::testing::NAME##_tag)

/// The same for a tag of your own, which says besides what overrides of yours do otherwise: under_test.hpp.
#define PHOTONGRID_TEST_BACKEND_AS(NAME, TAG)                                                                          \
    namespace photongrid::testing {                                                                                    \
    INSTANTIATE_TYPED_TEST_SUITE_P(NAME, verbs, ::testing::Types<TAG>, tag_names);                                     \
    INSTANTIATE_TYPED_TEST_SUITE_P(NAME, algorithms, ::testing::Types<TAG>, tag_names);                                \
    INSTANTIATE_TYPED_TEST_SUITE_P(NAME, estimators, ::testing::Types<TAG>, tag_names);                                \
    INSTANTIATE_TYPED_TEST_SUITE_P(NAME, neighbours, ::testing::Types<TAG>, tag_names);                                \
    INSTANTIATE_TYPED_TEST_SUITE_P(NAME, hard_cases_of_numbers, ::testing::Types<TAG>, tag_names);                     \
    INSTANTIATE_TYPED_TEST_SUITE_P(NAME, map_files, ::testing::Types<TAG>, tag_names);                                 \
    }                                                                                                                  \
    static_assert(true)
