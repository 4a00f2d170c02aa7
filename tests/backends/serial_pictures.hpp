// Algorithms, tracing and pictures on the serial backend, as photongrid::renderer has compiled them.
#pragma once

#include "serial_algorithms.hpp"

#include <photongrid/backends/any/compiled_algorithms.hpp>

namespace photongrid {

PHOTONGRID_ALGORITHMS(extern, serial_backend)
PHOTONGRID_PICTURES(extern, serial_backend)

} // namespace photongrid
