// Scenes of other programs.
#include "five_formats_tests.hpp"
#include "glass_body_tests.hpp"
#include "gltf_file_tests.hpp"
#include "mitsuba_file_tests.hpp"
#include "named_file_tests.hpp"
#include "obj_scene_tests.hpp"
#include "pbrt_file_tests.hpp"
#include "spectra_tests.hpp"
