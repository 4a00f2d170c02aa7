// What the chooser knows of each backend. One file per backend defines its entry, so that the renderer is compiled for
// each apart; CMake lists the entries of those that are built.
#pragma once

#include <photongrid/backends/any/any.hpp>

#include <optional>
#include <span>

namespace photongrid::any {

/// A backend's way in.
struct backend_entry {
    std::vector<std::string> names; ///< by which renderer_options asks for it
    std::unique_ptr<renderer> (*make)(const renderer_options&);
    std::vector<device_report> (*devices)();
    /// The device that "auto" should take, where there is one that is no CPU; null for a backend that never has.
    std::optional<std::string> (*hardware)();
};

backend_entry serial_entry();
backend_entry cpu_entry();
backend_entry gl_entry();
backend_entry vulkan_entry();

/// Those that are built; CMake makes its file.
std::span<const backend_entry> built_backends();

/// A device's limits in words.
std::string limits(const capabilities& c);

} // namespace photongrid::any
