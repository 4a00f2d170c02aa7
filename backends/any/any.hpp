// A renderer on a backend that is chosen at run time. This header names no backend's library; the compiled component
// photongrid::renderer holds those that were built.
//
//     const auto device = photongrid::make_renderer({.backend = "vulkan"});
//     const auto [picture, stats] = photongrid::render(*device, scene);
#pragma once

#include <photongrid/render/renderer.hpp>

#include <memory>
#include <string>
#include <vector>

namespace photongrid {

/// Which backend, and how.
struct renderer_options {
    std::string backend = "auto"; ///< serial, cpu, gl, gl-osmesa, vulkan; auto: see chosen()
    unsigned threads = 0;         ///< of cpu; 0: all
    std::string device{};         ///< of vulkan: an index or a part of a name; empty: the best
    std::string shader_cache{};   ///< folder where Vulkan's compiled kernels are kept; empty: nowhere
    bool time_passes = false;     ///< on vulkan, gl and gl-osmesa
};

/// `o` with a backend's name for "auto": a hardware Vulkan device where there is one, a discrete one before others;
/// else cpu where it was built, else serial.
renderer_options chosen(renderer_options o);

/// A renderer and its backend. OpenGL's belongs to the thread that calls.
/// \throws backend_error when the backend or device cannot be had, or was not built; std::invalid_argument for a
///         backend's name that is none.
std::unique_ptr<renderer> make_renderer(const renderer_options& o = {});

/// A device that a backend has here, or why it has none.
struct device_report {
    std::string backend{}; ///< as renderer_options takes it
    std::string device{};  ///< empty where there is none
    bool works = false;
    std::string description{}; ///< its limits, or why it cannot be had
};

/// The devices of all backends. Opens each in turn.
std::vector<device_report> find_devices();

} // namespace photongrid
