// A logical Vulkan device. All of this backend uses the C API: <vulkan/vulkan_raii.hpp> takes seconds to compile in
// every file.
#pragma once

#include <photongrid/backends/vulkan/physical_device.hpp>

namespace photongrid::vulkan {

/// A logical device of the backend, or a caller's.
class logical_device {
public:
    logical_device(VkPhysicalDevice physical)
    {
        family_ = *compute_family(physical);
        const float priority = 1.0f;
        VkDeviceQueueCreateInfo queue{};
        queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        queue.queueFamilyIndex = family_;
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        VkDeviceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queue;
        constexpr const char* subset = "VK_KHR_portability_subset";
        if (device_has_extension(physical, subset)) { // then it must be enabled
            info.enabledExtensionCount = 1;
            info.ppEnabledExtensionNames = &subset;
        }
        check(vkCreateDevice(physical, &info, nullptr, &handle_), "vkCreateDevice");
        owned_ = true;
        vkGetDeviceQueue(handle_, family_, 0, &queue_);
    }
    explicit logical_device(const vulkan_handles& h) : handle_(h.device), queue_(h.queue), family_(h.queue_family) {}
    logical_device(const logical_device&) = delete;
    logical_device& operator=(const logical_device&) = delete;
    ~logical_device()
    {
        if (owned_)
            vkDestroyDevice(handle_, nullptr);
    }
    VkDevice get() const { return handle_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t family() const { return family_; }

private:
    VkDevice handle_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t family_ = 0;
    bool owned_ = false;
};

} // namespace photongrid::vulkan
