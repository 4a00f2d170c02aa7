// Everything that the Vulkan backend does faster than by kernels. Include it before the algorithms are used with a
// vulkan_backend.
#pragma once

#include <photongrid/backends/vulkan/overrides/bitonic_sort.hpp>
#include <photongrid/backends/vulkan/overrides/trace_batch.hpp>
