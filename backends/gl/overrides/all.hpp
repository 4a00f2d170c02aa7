// Everything that the OpenGL backend does faster than by the generic algorithms. Include it before these are used with
// a gl_backend.
#pragma once

#include <photongrid/backends/gl/overrides/bitonic_sort.hpp>
