#include <photongrid/backends/vulkan/vulkan.hpp>

#include "nearest.hpp"

int main()
{
    photongrid::vulkan_backend device;
    return consumer::nearest(device);
}
