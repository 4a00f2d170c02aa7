// For programs that include this file; gl.hpp suffices.
#pragma once

#include <photongrid/backends/gl/gl.hpp>
