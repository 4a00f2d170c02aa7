// The Vulkan backend with maps, searches and pictures on it, as photongrid::renderer has compiled them.
#pragma once

#include <photongrid/backends/vulkan/vulkan.hpp>

#include <photongrid/backends/any/compiled_algorithms.hpp>

namespace photongrid {

PHOTONGRID_ALGORITHMS(extern, vulkan_backend)
PHOTONGRID_PICTURES(extern, vulkan_backend)

} // namespace photongrid
