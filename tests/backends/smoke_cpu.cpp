#include <photongrid/backends/cpu/cpu.hpp>

#include "smoke.hpp"

int main()
{
    photongrid::cpu_backend b(2);
    return photongrid::testing::smoke(b);
}
