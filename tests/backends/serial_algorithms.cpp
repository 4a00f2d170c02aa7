#define PHOTONGRID_COMPILED_HERE
#include "serial_algorithms.hpp"
