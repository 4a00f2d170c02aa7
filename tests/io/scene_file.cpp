// The reader of scene files: accepted files, and the line and text of every kind of error.
#include "light_file_tests.hpp"
#include "mesh_file_tests.hpp"
#include "obj_file_tests.hpp"
#include "scene_edit_tests.hpp"
#include "scene_reading_tests.hpp"
#include "scene_refusal_tests.hpp"
#include "scene_schema_tests.hpp"
#include "texture_file_tests.hpp"
