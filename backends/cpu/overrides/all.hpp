// What cpu.hpp includes anyway; kept for programs that name this file.
#pragma once

#include <photongrid/backends/cpu/cpu.hpp>
