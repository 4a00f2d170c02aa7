// Kernels of the tests of the OpenGL backend: those of tests/backends/gl_kernels, and those with mistakes.
#pragma once

#include "gl_algorithms.hpp"
#include "gl_broken_kernels.hpp"
#include "serial_algorithms.hpp"

#include <gl_kernels_kernels.hpp>
#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/bitonic_sort.hpp>
#include <photongrid/map/grid_index.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/map/pair_value.kernel.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <numeric>
#include <optional>
#include <random>
#include <thread>

namespace photongrid {
namespace {

    namespace test_kernels {
        using gl_kernels::eight;
        using gl_kernels::is_odd;
        using gl_kernels::next_frame;
        using gl_kernels::to_place;
    } // namespace test_kernels

} // namespace
} // namespace photongrid
