// What gl.hpp includes anyway; kept for programs that name this file.
#pragma once

#include <photongrid/backends/gl/gl.hpp>
