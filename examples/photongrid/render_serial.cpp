#include "render_on.hpp"

#include <photongrid/backends/serial/serial.hpp>

namespace photongrid {

render_result render_serial(const render_job& job)
{
    serial_backend b;
    return render_on(b, job);
}

device_report serial_device()
{
    const serial_backend b;
    return {.backend = "serial", .device = b.caps().device, .works = true, .about = limits(b.caps())};
}

} // namespace photongrid
