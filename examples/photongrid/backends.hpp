// What the program asks of a backend. Each backend is a translation unit of its own (the renderer is compiled once for
// each), or a function that says why it is not there; CMake chooses.
#pragma once

#include <photongrid/backend/backend.hpp>
#include <photongrid/render/previews.hpp>
#include <photongrid/render/render_state.hpp>
#include <photongrid/render/render_stats.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace photongrid {

/// A progressive_render, whatever its backend. One thread calls; cancel() any.
class renderer {
public:
    renderer() = default;
    renderer(const renderer&) = delete;
    renderer& operator=(const renderer&) = delete;
    virtual ~renderer() = default;

    // See progressive_render.
    virtual void start(const scene& s, const render_settings& settings, const preview_settings& previews) = 0;
    virtual void resume(render_state state) = 0;
    virtual render_state state() = 0;
    virtual bool step(double budget_ms) = 0; ///< infinite: to the end
    virtual void cancel() = 0;
    virtual bool finished() const = 0;
    virtual std::uint64_t pictures() const = 0;
    virtual image picture() = 0;
    virtual render_progress progress() const = 0;
    virtual const render_stats& stats() const = 0;
    virtual std::uint64_t maps() const = 0;

    // See the backend concept.
    virtual const capabilities& caps() const = 0;
    virtual const std::map<std::string, kernel_cost>& costs() const = 0;
};

/// Which backend, and how.
struct renderer_options {
    std::string backend = "cpu"; ///< serial, cpu, gl, gl-osmesa or vulkan
    unsigned threads = 0;        ///< of cpu; 0: all
    std::string device{};        ///< of vulkan: an index or a part of a name; empty: the best
    std::string shader_cache{};  ///< folder where Vulkan's compiled kernels are kept; empty: nowhere
    bool time_passes = false;    ///< on vulkan, gl and gl-osmesa
};

/// Throws backend_error when the backend or device cannot be had, or the program was built without it. OpenGL's belongs
/// to the calling thread.
std::unique_ptr<renderer> make_renderer(const renderer_options& o);

// make_renderer's choices.
std::unique_ptr<renderer> serial_renderer();
std::unique_ptr<renderer> cpu_renderer(const renderer_options& o);
std::unique_ptr<renderer> gl_renderer(const renderer_options& o);
std::unique_ptr<renderer> vulkan_renderer(const renderer_options& o);

/// Whether the program was built with the cpu backend.
bool has_cpu();

/// The index of the best Vulkan device that is not a CPU, if there is one.
std::optional<std::string> hardware_vulkan_device();

/// A line of `photongrid devices`.
struct device_report {
    std::string backend{}; ///< as --backend takes it
    std::string device{};  ///< empty where there is none
    bool works = false;
    std::string about{}; ///< its limits, or why it cannot be had
};

device_report serial_device();
std::vector<device_report> cpu_devices();
std::vector<device_report> gl_devices();
std::vector<device_report> vulkan_devices_report();

/// A device's limits in words.
std::string limits(const capabilities& c);

} // namespace photongrid
