// For programs that include this file; cpu.hpp suffices.
#pragma once

#include <photongrid/backends/cpu/cpu.hpp>
