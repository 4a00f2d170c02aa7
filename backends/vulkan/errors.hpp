// Vulkan's result codes as backend_error.
#pragma once

#include <photongrid/core/backend.hpp>

#include <cstdlib>
#include <string>
#include <vulkan/vulkan.h>

namespace photongrid::vulkan {

/// The name of a result code, such as "VK_ERROR_DEVICE_LOST".
inline std::string result_name(VkResult r)
{
    switch (r) {
#define PHOTONGRID_NAME(R)                                                                                             \
    case R: return #R;
        PHOTONGRID_NAME(VK_SUCCESS)
        PHOTONGRID_NAME(VK_NOT_READY)
        PHOTONGRID_NAME(VK_TIMEOUT)
        PHOTONGRID_NAME(VK_INCOMPLETE)
        PHOTONGRID_NAME(VK_ERROR_OUT_OF_HOST_MEMORY)
        PHOTONGRID_NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        PHOTONGRID_NAME(VK_ERROR_INITIALIZATION_FAILED)
        PHOTONGRID_NAME(VK_ERROR_DEVICE_LOST)
        PHOTONGRID_NAME(VK_ERROR_MEMORY_MAP_FAILED)
        PHOTONGRID_NAME(VK_ERROR_LAYER_NOT_PRESENT)
        PHOTONGRID_NAME(VK_ERROR_EXTENSION_NOT_PRESENT)
        PHOTONGRID_NAME(VK_ERROR_FEATURE_NOT_PRESENT)
        PHOTONGRID_NAME(VK_ERROR_INCOMPATIBLE_DRIVER)
        PHOTONGRID_NAME(VK_ERROR_TOO_MANY_OBJECTS)
        PHOTONGRID_NAME(VK_ERROR_OUT_OF_POOL_MEMORY)
        PHOTONGRID_NAME(VK_ERROR_FRAGMENTED_POOL)
        PHOTONGRID_NAME(VK_ERROR_INVALID_SHADER_NV)
        PHOTONGRID_NAME(VK_ERROR_UNKNOWN)
#undef PHOTONGRID_NAME
    default: return "VkResult " + std::to_string(static_cast<int>(r));
    }
}

/// Throws backend_error unless `r` is VK_SUCCESS. `what` is the call and its purpose.
inline void check(VkResult r, const std::string& what)
{
    if (r == VK_SUCCESS)
        return;
    std::string text = "vulkan: " + what + ": " + result_name(r);
    if (r == VK_ERROR_DEVICE_LOST)
        text += ". The device was lost: the driver reset it, usually because a pass ran too long. Reduce the work per "
                "pass (visits_per_pass), and create a new backend: all further calls on this one will fail";
    if (r == VK_ERROR_OUT_OF_DEVICE_MEMORY || r == VK_ERROR_OUT_OF_HOST_MEMORY)
        text += ". Use fewer photons, a smaller picture or a coarser grid, or close other programs on this device";
    throw backend_error(text);
}

/// The folders in which the loader searches for drivers, for messages.
inline std::string driver_search_paths()
{
    std::string text;
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"})
        if (const char* value = std::getenv(name))
            text += std::string(name) + "=" + value + " ";
    return text.empty() ? "the loader's default folders, such as /usr/share/vulkan/icd.d"
                        : text + "(from the environment)";
}

inline constexpr const char* install_hint
    = "Install a driver (Debian: apt install mesa-vulkan-drivers), or use another backend";

} // namespace photongrid::vulkan
