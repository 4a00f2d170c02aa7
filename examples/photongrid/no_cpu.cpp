// Stands for render_cpu.cpp where CMake found no oneTBB or no Highway.
#include "backends.hpp"

namespace photongrid {

namespace {
    const char* const reason = "cpu: this photongrid was built without the cpu backend; install libtbb-dev and "
                               "libhwy-dev, then configure with -DPHOTONGRID_CPU=ON";
}

std::unique_ptr<renderer> cpu_renderer(const renderer_options&) { throw backend_error(reason); }

std::vector<device_report> cpu_devices() { return {{.backend = "cpu", .about = reason}}; }

bool has_cpu() { return false; }

} // namespace photongrid
