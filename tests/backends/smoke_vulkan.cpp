#include "smoke.hpp"

#include <photongrid/backends/vulkan/vulkan.hpp>

int main()
{
    photongrid::vulkan_backend b;
    return photongrid::testing::smoke(b);
}
