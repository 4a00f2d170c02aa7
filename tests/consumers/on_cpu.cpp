#include <photongrid/backends/cpu/cpu.hpp>

#include "nearest.hpp"

int main()
{
    photongrid::cpu_backend device;
    return consumer::nearest(device);
}
