// A caller with a Vulkan device of its own.
#pragma once

#include "../core/under_test.hpp"
#include "../map/photon_sets.hpp"
#include "on_serial.hpp"
#include "vulkan_algorithms.hpp"

#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/pair_value.kernel.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace photongrid::testing {

using glm::uvec2;
using glm::vec4;

void expect_success(VkResult r, const char* what)
{
    if (r != VK_SUCCESS)
        throw std::runtime_error(std::string(what) + " failed with " + std::to_string(r));
}

/// An application with a device and commands of its own, by the plain API and nothing of ours.
class application {
public:
    application()
    {
        VkApplicationInfo app{};
        app.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
        app.apiVersion = VK_API_VERSION_1_1;
        constexpr const char* layer = "VK_LAYER_KHRONOS_validation";
        constexpr const char* extensions[]
            = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
        constexpr VkValidationFeatureEnableEXT synchronization
            = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
        VkDebugUtilsMessengerCreateInfoEXT messenger{};
        messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
        messenger.messageSeverity
            = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        messenger.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                        const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) -> VkBool32 {
            static_cast<std::vector<std::string>*>(user)->emplace_back(data->pMessage);
            return VK_FALSE;
        };
        messenger.pUserData = &messages;
        VkValidationFeaturesEXT features{};
        features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
        features.enabledValidationFeatureCount = 1;
        features.pEnabledValidationFeatures = &synchronization;
        VkInstanceCreateInfo instance_info{};
        instance_info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
        instance_info.pNext = &features;
        instance_info.pApplicationInfo = &app;
        instance_info.enabledLayerCount = 1;
        instance_info.ppEnabledLayerNames = &layer;
        instance_info.enabledExtensionCount = 2;
        instance_info.ppEnabledExtensionNames = extensions;
        expect_success(vkCreateInstance(&instance_info, nullptr, &handles.instance),
            "vkCreateInstance (with the validation layer; Debian: vulkan-validationlayers)");
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(handles.instance, "vkCreateDebugUtilsMessengerEXT"));
        expect_success(create(handles.instance, &messenger, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
        std::uint32_t one = 1;
        if (vkEnumeratePhysicalDevices(handles.instance, &one, &handles.physical_device) < VK_SUCCESS || one == 0)
            throw std::runtime_error("no Vulkan device");
        handles.queue_family = photongrid::vulkan::compute_family(handles.physical_device).value();
        const float priority = 1;
        VkDeviceQueueCreateInfo queue{};
        queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        queue.queueFamilyIndex = handles.queue_family;
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        VkDeviceCreateInfo device_info{};
        device_info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
        device_info.queueCreateInfoCount = 1;
        device_info.pQueueCreateInfos = &queue;
        expect_success(
            vkCreateDevice(handles.physical_device, &device_info, nullptr, &handles.device), "vkCreateDevice");
        vkGetDeviceQueue(handles.device, handles.queue_family, 0, &handles.queue);
        VkCommandPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        pool.queueFamilyIndex = handles.queue_family;
        expect_success(vkCreateCommandPool(handles.device, &pool, nullptr, &pool_), "vkCreateCommandPool");
    }
    application(const application&) = delete;
    application& operator=(const application&) = delete;
    ~application()
    {
        vkDestroyCommandPool(handles.device, pool_, nullptr);
        vkDestroyDevice(handles.device, nullptr);
        reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
            handles.instance, "vkDestroyDebugUtilsMessengerEXT"))(handles.instance, messenger_, nullptr);
        vkDestroyInstance(handles.instance, nullptr);
    }

    /// A buffer of the application's own that the host can see.
    struct own_buffer {
        VkDevice device = VK_NULL_HANDLE;
        VkBuffer buffer = VK_NULL_HANDLE;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkDeviceSize bytes = 0;
        own_buffer() = default;
        own_buffer(const own_buffer&) = delete;
        own_buffer& operator=(const own_buffer&) = delete;
        ~own_buffer()
        {
            vkDestroyBuffer(device, buffer, nullptr);
            vkFreeMemory(device, memory, nullptr);
        }
        template <class T>
        std::vector<T> contents() const
        {
            std::vector<T> data(bytes / sizeof(T));
            void* at = nullptr;
            expect_success(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &at), "vkMapMemory");
            std::memcpy(data.data(), at, bytes);
            vkUnmapMemory(device, memory);
            return data;
        }
        template <class T>
        void fill(const std::vector<T>& data)
        {
            void* at = nullptr;
            expect_success(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &at), "vkMapMemory");
            std::memcpy(at, data.data(), data.size() * sizeof(T));
            vkUnmapMemory(device, memory);
        }
    };
    void make(own_buffer& b, VkDeviceSize bytes, VkBufferUsageFlags usage)
    {
        b.device = handles.device;
        b.bytes = bytes;
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = bytes;
        info.usage = usage;
        expect_success(vkCreateBuffer(handles.device, &info, nullptr, &b.buffer), "vkCreateBuffer");
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(handles.device, b.buffer, &needs);
        VkPhysicalDeviceMemoryProperties types;
        vkGetPhysicalDeviceMemoryProperties(handles.physical_device, &types);
        VkMemoryAllocateInfo memory{};
        memory.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        memory.allocationSize = needs.size;
        constexpr VkMemoryPropertyFlags host
            = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        while (((needs.memoryTypeBits >> memory.memoryTypeIndex) & 1u) == 0
            || (types.memoryTypes[memory.memoryTypeIndex].propertyFlags & host) != host)
            ++memory.memoryTypeIndex;
        expect_success(vkAllocateMemory(handles.device, &memory, nullptr, &b.memory), "vkAllocateMemory");
        expect_success(vkBindBufferMemory(handles.device, b.buffer, b.memory, 0), "vkBindBufferMemory");
    }

    /// Commands that copy; submitted, not waited for.
    VkCommandBuffer record_copy(VkBuffer from, VkBuffer to, VkDeviceSize bytes)
    {
        VkCommandBufferAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        info.commandPool = pool_;
        info.commandBufferCount = 1;
        VkCommandBuffer c = VK_NULL_HANDLE;
        expect_success(vkAllocateCommandBuffers(handles.device, &info, &c), "vkAllocateCommandBuffers");
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        expect_success(vkBeginCommandBuffer(c, &begin), "vkBeginCommandBuffer");
        const VkBufferCopy region{0, 0, bytes};
        vkCmdCopyBuffer(c, from, to, 1, &region);
        expect_success(vkEndCommandBuffer(c), "vkEndCommandBuffer");
        return c;
    }
    void submit(VkCommandBuffer c)
    {
        VkSubmitInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        info.commandBufferCount = 1;
        info.pCommandBuffers = &c;
        expect_success(vkQueueSubmit(handles.queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
    }
    void wait() { expect_success(vkQueueWaitIdle(handles.queue), "vkQueueWaitIdle"); }

    vulkan_handles handles;
    std::vector<std::string> messages; ///< of the validation layer

private:
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
};

class callers_device : public ::testing::Test {
protected:
    void TearDown() override { EXPECT_EQ(app.messages, std::vector<std::string>{}); }
    application app;
    serial_backend serial;
};

std::vector<uvec2> random_pairs(std::size_t n)
{
    random_source u(n);
    std::vector<uvec2> pairs;
    for (std::size_t i = 0; i < n; ++i)
        pairs.emplace_back(u.below(1000), static_cast<uint>(i));
    return pairs;
}
std::vector<uvec2> in_order(std::vector<uvec2> pairs)
{
    std::sort(pairs.begin(), pairs.end(), [](uvec2 a, uvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    return pairs;
}

} // namespace photongrid::testing
