// For programs that still include this file, which earlier versions needed; cpu.hpp suffices.
#pragma once

#include <photongrid/backends/cpu/cpu.hpp>
