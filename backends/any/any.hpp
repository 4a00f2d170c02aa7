// Creates a renderer on a backend that is chosen at run time. This header does not depend on the backends' libraries;
// the compiled component photongrid::renderer has the backends that were built.
//
//     const auto device = photongrid::make_renderer({.backend = "vulkan"});
//     const auto [picture, stats] = photongrid::render(*device, scene);
#pragma once

#include <photongrid/render/renderer.hpp>

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace photongrid {

/// The backend and its options.
/// \headerfile backends/any/any.hpp <photongrid/backends/any/any.hpp>
struct renderer_options {
    std::string backend = "auto"; ///< serial, cpu, gl, gl-osmesa, vulkan; auto: see candidates()
    unsigned threads = 0;         ///< of cpu; 0: as many as the machine has
    std::string device{};         ///< of vulkan: an index or part of a name; empty: the best
    std::string shader_cache{};   ///< folder for Vulkan's compiled kernels; empty: none
    bool time_passes = false;     ///< measure passes, on vulkan, gl and gl-osmesa
};

/// What "auto" may stand for: vulkan if there is a hardware Vulkan device (discrete ones first), then cpu, or serial in
/// a build without it. `o` alone if it names a backend.
std::vector<renderer_options> candidates(const renderer_options& o);

/// A backend, and how long it takes for a pass of a picture.
/// \headerfile backends/any/any.hpp <photongrid/backends/any/any.hpp>
struct timed_backend {
    renderer_options options{};
    double pass_seconds = std::numeric_limits<double>::infinity(); ///< infinity: the backend fails
    std::string failure{};                                         ///< what it says then
};

/// Times a picture of `s` on each of the backends: the fastest first. It draws some passes with a sixteenth and with a
/// quarter of the pixels and photons, from which it extrapolates; that takes about as long as a pass of the picture,
/// compilation apart.
/// \throws what renderer::start() throws for the scene and the settings.
std::vector<timed_backend> by_speed(
    std::span<const renderer_options> backends, const scene& s, const render_settings& settings);

/// Creates a renderer with its backend, the first of candidates(). A renderer on OpenGL belongs to the calling thread.
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
