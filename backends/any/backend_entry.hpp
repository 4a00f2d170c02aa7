// The entry of a backend for make_renderer. Each backend has a file that defines its entry, so that renderers are
// compiled separately; CMake generates the list of the backends of a build (cmake/renderer.cmake).
#pragma once

#include <photongrid/backends/any/any.hpp>

#include <optional>
#include <span>

namespace photongrid::any {

/// The entry of a backend.
struct backend_entry {
    std::unique_ptr<renderer> (*make)(const renderer_options&);
    std::vector<device_report> (*devices)();
    /// The hardware device that "auto" should use, if there is one; null for a backend that has none.
    std::optional<std::string> (*hardware)();
};

backend_entry serial_entry();
backend_entry cpu_entry();
backend_entry gl_entry();
backend_entry vulkan_entry();

/// A backend of this build. Its entry is linked, or in a module that is loaded when it is asked for.
struct built_backend {
    const char* name;
    backend_entry (*entry)(); ///< throws backend_error if its module cannot be loaded
};

/// The backends of this build, in a file that CMake generates.
std::span<const built_backend> built_backends();

/// Describes a device's limits.
std::string limits(const capabilities& c);

} // namespace photongrid::any
