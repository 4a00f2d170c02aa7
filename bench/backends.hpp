// Every backend, by its name.
#pragma once

#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/backends/vulkan/vulkan.hpp>

#include <set>
#include <stdexcept>
#include <string>

namespace photongrid::bench {

inline const std::set<std::string> backend_names{"serial", "cpu", "gl", "vulkan"};

/// What `use` returns of a new backend; `name` is one of those above.
template <class Use>
auto on_backend(const std::string& name, const Use& use)
{
    return name == "serial" ? use(serial_backend())
        : name == "cpu"     ? use(cpu_backend())
        : name == "gl"      ? use(gl_backend())
                            : use(vulkan_backend());
}

} // namespace photongrid::bench
