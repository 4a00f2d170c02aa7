#include <photongrid/backends/any/owning_renderer.hpp>
#include <photongrid/backends/serial/serial.hpp>

namespace photongrid::any {

namespace {
    std::unique_ptr<renderer> make(const renderer_options&)
    {
        return std::make_unique<owning_renderer<serial_backend>>();
    }

    std::vector<device_report> devices()
    {
        const serial_backend b;
        return {{.backend = "serial", .device = b.caps().device, .works = true, .description = limits(b.caps())}};
    }
} // namespace

backend_entry serial_entry() { return {make, devices, nullptr}; }

} // namespace photongrid::any

#ifdef PHOTONGRID_COMPILES_ALGORITHMS
#include <photongrid/backends/any/compiled_algorithms.hpp>

namespace photongrid {
PHOTONGRID_ALGORITHMS(, serial_backend)
PHOTONGRID_PICTURES(, serial_backend)
} // namespace photongrid
#endif
