#include "renderer_on.hpp"

#include <photongrid/backends/serial/serial.hpp>

namespace photongrid {

std::unique_ptr<renderer> serial_renderer() { return std::make_unique<renderer_on<serial_backend>>(); }

device_report serial_device()
{
    const serial_backend b;
    return {.backend = "serial", .device = b.caps().device, .works = true, .about = limits(b.caps())};
}

} // namespace photongrid
