#include "smoke.hpp"

#include <photongrid/backends/serial/serial.hpp>

int main()
{
    photongrid::serial_backend b;
    return photongrid::testing::smoke(b);
}
