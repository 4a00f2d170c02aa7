// What the program asks of a backend. Each backend is a translation unit of its own (the renderer is compiled once for
// each), or a function that says why it is not there; CMake chooses.
#pragma once

#include <photongrid/backend.hpp>
#include <photongrid/render_stats.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace photongrid {

/// A picture to draw. `device`: for Vulkan, an index or a part of a name; empty for the best.
struct render_job {
    const photongrid::scene& scene;
    render_settings settings;
    render_observer observer{};
    std::string device{};
    bool time_passes = false;   ///< on Vulkan and OpenGL
    std::string shader_cache{}; ///< folder where Vulkan's compiled kernels are kept; empty: nowhere
};

/// The picture and what it took.
struct render_result {
    image picture;
    render_stats stats;
    capabilities caps;
    std::map<std::string, kernel_cost> costs;
};

render_result render_serial(const render_job& job);
/// `threads`: 0 for all. Throws backend_error where the program was built without this backend, as has_cpu() tells.
render_result render_cpu(const render_job& job, unsigned threads);
bool has_cpu();
/// `osmesa`: on OSMesa, else on EGL. Throws backend_error when the context cannot be had.
render_result render_gl(const render_job& job, bool osmesa);
/// Throws backend_error when there is no such device.
render_result render_vulkan(const render_job& job);

/// The index of the best Vulkan device that is not a CPU, if there is one.
std::optional<std::string> hardware_vulkan_device();

/// A line of `photongrid devices`.
struct device_report {
    std::string backend{}; ///< as --backend takes it
    std::string device{};  ///< empty where there is none
    bool works = false;
    std::string about{};   ///< its limits, or why it cannot be had
};

device_report serial_device();
std::vector<device_report> cpu_devices();
std::vector<device_report> gl_devices();
std::vector<device_report> vulkan_devices_report();

/// A device's limits in words.
std::string limits(const capabilities& c);

} // namespace photongrid
