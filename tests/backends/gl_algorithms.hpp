// The OpenGL backend with maps, searches and pictures on it, as photongrid::renderer has compiled them.
#pragma once

#include <photongrid/backends/gl/gl.hpp>

#include <photongrid/backends/any/compiled_algorithms.hpp>

namespace photongrid {

PHOTONGRID_ALGORITHMS(extern, gl_backend)
PHOTONGRID_PICTURES(extern, gl_backend)

} // namespace photongrid
