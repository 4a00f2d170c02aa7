#include <photongrid/backends/cpu/overrides/all.hpp>

#include "render_on.hpp"

namespace photongrid {

render_result render_cpu(const render_job& job, unsigned threads)
{
    cpu_backend b(threads);
    return render_on(b, job);
}

std::vector<device_report> cpu_devices()
{
    const cpu_backend b;
    return {{.backend = "cpu", .device = b.caps().device, .works = true, .about = limits(b.caps())}};
}

bool has_cpu() { return true; }

} // namespace photongrid
