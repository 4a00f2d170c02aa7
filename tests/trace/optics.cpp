// The physics of light paths on the serial backend: what is drawn at random, what surfaces do to light, and where they
// are. The other backends equal it bit for bit.
#include "coat_tests.hpp"
#include "rebound_tests.hpp"
#include "rough_tests.hpp"
#include "sampler_tests.hpp"
#include "scattering_tests.hpp"
#include "shape_tree_tests.hpp"
#include "surface_tests.hpp"
#include "verb_tests.hpp"
