#define PHOTONGRID_PICTURES_COMPILED_HERE
#include "serial_pictures.hpp"
