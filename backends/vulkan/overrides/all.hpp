// For programs that include this file; vulkan.hpp suffices.
#pragma once

#include <photongrid/backends/vulkan/vulkan.hpp>
