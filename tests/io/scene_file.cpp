// The reader of scene files: what it takes, and the place and words of every kind of refusal.
#include "scene_reading_tests.hpp"
#include "scene_refusal_tests.hpp"
#include "scene_schema_tests.hpp"
