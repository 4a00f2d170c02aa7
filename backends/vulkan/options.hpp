// Options of the Vulkan backend, and the devices that it may use: the caller's handles, and the list of all.
#pragma once

#include <photongrid/core/exact_arithmetic.hpp>

#include <cstdint>
#include <string>
#include <vulkan/vulkan.h>

namespace photongrid {

/// Options of the Vulkan backend.
/// \headerfile backends/vulkan/vulkan.hpp <photongrid/backends/vulkan/vulkan.hpp>
struct vulkan_options {
    std::string device{}; ///< "": the best (discrete, integrated, virtual, CPU); else an index or a part of the name
    bool hardware_only = false; ///< reject devices that are a CPU
    bool validation = false;   ///< run the Khronos validation layer (core and synchronization) and collect its messages
    bool gpu_assisted = false; ///< with validation: instrument kernels, so that accesses past a buffer's end give
                               ///< messages; slow
    bool staging = false;      ///< always work as on a discrete GPU: copy through staging buffers, read inputs as
                               ///< storage buffers, and let lanes exchange values in shared memory
    bool subgroups = true;     ///< let neighbouring points search in a subgroup, if the device supports it
    bool time_passes = false;  ///< measure passes by the device's clock, for costs(); a little slower
    arithmetic_kind arithmetic = arithmetic_kind::automatic; ///< how kernels compute quotients and square roots
    std::string cache_folder{};                              ///< folder in which compiled kernels are cached; "": none
};

/// A device that the caller has opened and continues to own. The instance must be for Vulkan 1.1 or later, and the
/// queue of a family with compute. No other thread may use the queue at the same time.
/// \headerfile backends/vulkan/vulkan.hpp <photongrid/backends/vulkan/vulkan.hpp>
struct vulkan_handles {
    VkInstance instance = VK_NULL_HANDLE;              ///< created for Vulkan 1.1 or later
    VkPhysicalDevice physical_device = VK_NULL_HANDLE; ///< a physical device of that instance
    VkDevice device = VK_NULL_HANDLE;                  ///< a device of that physical device
    VkQueue queue = VK_NULL_HANDLE;                    ///< a queue of that device, to which passes are submitted
    std::uint32_t queue_family = 0;                    ///< the family of the queue
};

/// A device in the list of `vulkan_devices()`.
/// \headerfile backends/vulkan/vulkan.hpp <photongrid/backends/vulkan/vulkan.hpp>
struct vulkan_device_info {
    std::uint32_t index = 0;               ///< for vulkan_options::device
    std::string name;                      ///< the driver's name for it
    std::string type;                      ///< "discrete", "integrated", "virtual", "cpu", "other"
    std::string driver;                    ///< the driver's name and version
    std::string api_version;               ///< "1.3.230"
    bool software = false;                 ///< true if the device is a CPU
    std::uint64_t max_buffer_bytes = 0;    ///< of one buffer in a pass
    std::uint64_t memory_bytes = 0;        ///< largest device-local heap
    std::uint32_t max_storage_buffers = 0; ///< per pass
    std::string unusable;                  ///< the reason why this backend cannot use it; empty if it can
};

} // namespace photongrid
