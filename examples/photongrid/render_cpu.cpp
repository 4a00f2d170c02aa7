#include <photongrid/backends/cpu/cpu.hpp>

#include "renderer_on.hpp"

namespace photongrid {

std::unique_ptr<renderer> cpu_renderer(const renderer_options& o)
{
    return std::make_unique<renderer_on<cpu_backend>>(o.threads);
}

std::vector<device_report> cpu_devices()
{
    const cpu_backend b;
    return {{.backend = "cpu", .device = b.caps().device, .works = true, .about = limits(b.caps())}};
}

bool has_cpu() { return true; }

} // namespace photongrid
