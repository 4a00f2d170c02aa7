// The entry of a backend for make_renderer. Each backend has a file that defines its entry, so that renderers are
// compiled separately; CMake generates the list of entries that are built.
#pragma once

#include <photongrid/backends/any/any.hpp>

#include <optional>
#include <span>

namespace photongrid::any {

/// The entry of a backend.
struct backend_entry {
    std::vector<std::string> names; ///< its names in renderer_options
    std::unique_ptr<renderer> (*make)(const renderer_options&);
    std::vector<device_report> (*devices)();
    /// The hardware device that "auto" should use, if there is one; null for a backend that has none.
    std::optional<std::string> (*hardware)();
};

backend_entry serial_entry();
backend_entry cpu_entry();
backend_entry gl_entry();
backend_entry vulkan_entry();

/// The backends that are built, in a file that CMake generates.
std::span<const backend_entry> built_backends();

/// Describes a device's limits.
std::string limits(const capabilities& c);

} // namespace photongrid::any
