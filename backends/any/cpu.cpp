#include <photongrid/backends/cpu/cpu.hpp>

#include <photongrid/backends/any/owning_renderer.hpp>

namespace photongrid::any {

namespace {
    std::unique_ptr<renderer> make(const renderer_options& o)
    {
        return std::make_unique<owning_renderer<cpu_backend>>(o.threads);
    }

    std::vector<device_report> devices()
    {
        const cpu_backend b;
        return {{.backend = "cpu", .device = b.caps().device, .works = true, .description = limits(b.caps())}};
    }
} // namespace

backend_entry cpu_entry() { return {make, devices, nullptr}; }

} // namespace photongrid::any

#ifdef PHOTONGRID_COMPILES_ALGORITHMS
#include <photongrid/backends/any/compiled_algorithms.hpp>

namespace photongrid {
PHOTONGRID_ALGORITHMS(, cpu_backend)
PHOTONGRID_PICTURES(, cpu_backend)
} // namespace photongrid
#endif
