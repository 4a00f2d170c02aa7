// Compiled to assembly with -ffp-contract=fast: photongrid's arithmetic has no fused multiplication and addition, while
// the host's has.
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/render/render.hpp>

#include "../nearest.hpp"

float host_arithmetic(float a, float b, float c) { return a * b + c; }

int nearest_of_photons()
{
    photongrid::serial_backend device;
    return consumer::nearest(device);
}

photongrid::image picture(const photongrid::scene& s)
{
    photongrid::serial_backend device;
    return photongrid::render(device, s).picture;
}
