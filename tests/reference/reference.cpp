// The reference renderer against analytic answers: form factors, integrating spheres, Fresnel's and Snell's equations,
// quadrature, and roots found by brute force in long double.
#include "bin_tests.hpp"
#include "known_light_tests.hpp"
#include "light_source_tests.hpp"
#include "mesh_tests.hpp"
#include "mirror_and_glass_tests.hpp"
#include "seed_and_thread_tests.hpp"
#include "shape_tests.hpp"
