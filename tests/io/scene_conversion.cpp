// Scenes that are written in other formats.
#include "gltf_round_trip_tests.hpp"
#include "gltf_writer_tests.hpp"
#include "pbrt_writer_tests.hpp"
#include "scene_conversion_tests.hpp"
