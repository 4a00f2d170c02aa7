#include <photongrid/backends/serial/serial.hpp>

#include "nearest.hpp"

int main()
{
    photongrid::serial_backend device;
    return consumer::nearest(device);
}
