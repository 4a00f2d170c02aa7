// Scenes of other programs.
#include "pbrt_file_tests.hpp"
#include "spectra_tests.hpp"
