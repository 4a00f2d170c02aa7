// The photon mapper against answers from outside: caustics of mirrors and glass from geometrical optics, irradiance by
// quadrature, two libraries' nearest neighbours, and the rates at which density estimates converge. Prints its numbers.
#include "convergence_tests.hpp"
#include "form_factor_tests.hpp"
#include "glass_ball_tests.hpp"
#include "known_error_tests.hpp"
#include "mirror_tests.hpp"
#include "mixed_light_tests.hpp"
#include "nearest_tests.hpp"
#include "reported_bias_tests.hpp"
#include "shading_normal_tests.hpp"
