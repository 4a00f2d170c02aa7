// Stands for render_vulkan.cpp where CMake found no Vulkan.
#include "backends.hpp"

namespace photongrid {

namespace {
    const char* const reason
        = "vulkan: this photongrid was built without the Vulkan backend; install libvulkan-dev, glslang-dev, "
          "glslang-tools, spirv-tools and mesa-vulkan-drivers, then configure with -DPHOTONGRID_VULKAN=ON";
}

std::unique_ptr<renderer> vulkan_renderer(const renderer_options&) { throw backend_error(reason); }

std::optional<std::string> hardware_vulkan_device() { return std::nullopt; }

std::vector<device_report> vulkan_devices_report() { return {{.backend = "vulkan", .about = reason}}; }

} // namespace photongrid
