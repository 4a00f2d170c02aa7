// The cpu backend with maps, searches and pictures on it, as photongrid::renderer has compiled them.
#pragma once

#include <photongrid/backends/cpu/cpu.hpp>

#include <photongrid/backends/any/compiled_algorithms.hpp>

namespace photongrid {

PHOTONGRID_ALGORITHMS(extern, cpu_backend)
PHOTONGRID_PICTURES(extern, cpu_backend)

} // namespace photongrid
