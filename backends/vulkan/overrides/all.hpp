// What vulkan.hpp includes anyway; kept for programs that name this file.
#pragma once

#include <photongrid/backends/vulkan/vulkan.hpp>
