// What differs between two pictures, and where.
#include "error_map_tests.hpp"
#include "error_sheet_tests.hpp"
#include "flip_tests.hpp"
