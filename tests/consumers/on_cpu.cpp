#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/backends/cpu/overrides/all.hpp>

#include "nearest.hpp"

int main()
{
    photongrid::cpu_backend device;
    return consumer::nearest(device);
}
