// Creates a renderer on a backend that is chosen at run time. This header does not depend on the backends' libraries;
// the compiled component photongrid::renderer has the backends that were built.
//
//     const auto device = photongrid::make_renderer({.backend = "vulkan"});
//     const auto [picture, stats] = photongrid::render(*device, scene);
#pragma once

#include <photongrid/render/renderer.hpp>

#include <memory>
#include <string>
#include <vector>

namespace photongrid {

/// The backend and its options.
/// \headerfile backends/any/any.hpp <photongrid/backends/any/any.hpp>
struct renderer_options {
    std::string backend = "auto"; ///< serial, cpu, gl, gl-osmesa, vulkan; auto: see chosen()
    unsigned threads = 0;         ///< of cpu; 0: as many as the machine has
    std::string device{};         ///< of vulkan: an index or part of a name; empty: the best
    std::string shader_cache{};   ///< folder for Vulkan's compiled kernels; empty: none
    bool time_passes = false;     ///< measure passes, on vulkan, gl and gl-osmesa
};

/// `o` with "auto" replaced by a backend's name: vulkan if there is a hardware Vulkan device (discrete ones first),
/// else cpu if it was built, else serial.
renderer_options chosen(renderer_options o);

/// Creates a renderer with its backend. A renderer on OpenGL belongs to the calling thread.
/// \throws backend_error if the backend was not built or cannot be opened; std::invalid_argument for an unknown
///         backend.
std::unique_ptr<renderer> make_renderer(const renderer_options& o = {});

/// A device of a backend, or the reason why it has none.
/// \headerfile backends/any/any.hpp <photongrid/backends/any/any.hpp>
struct device_report {
    std::string backend{}; ///< as in renderer_options
    std::string device{};  ///< its name; empty if there is none
    bool works = false;
    std::string description{}; ///< its limits, or why it cannot be used
};

/// The devices of all backends. It opens each of them.
std::vector<device_report> find_devices();

} // namespace photongrid
