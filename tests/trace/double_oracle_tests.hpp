// The kernel files read as C++ once more, with double in place of float: the numerical oracle of the float pipeline.
// Random numbers are the same, since they are 24-bit integers times 2^-24.
#pragma once
#include "double_estimate_tests.hpp"
#include "double_ray_tests.hpp"
