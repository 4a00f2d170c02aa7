// A program with a Vulkan device of its own: the library sorts the program's buffer, and the program's commands on the
// same queue read the result, without waiting in between.
#include <photongrid/backends/vulkan/vulkan.hpp>

#include <cstddef>
#include <cstring>
#include <iostream>
#include <stdexcept>

namespace {

void check(VkResult r, const char* what)
{
    if (r != VK_SUCCESS)
        throw std::runtime_error(std::string(what) + " failed with " + std::to_string(r));
}

/// Objects that a Vulkan program has anyway: a device, a queue, commands, buffers that the host can see.
struct application {
    photongrid::vulkan_handles handles;
    VkCommandPool pool = VK_NULL_HANDLE;

    application()
    {
        VkApplicationInfo app{};
        app.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
        app.apiVersion = VK_API_VERSION_1_1;
        VkInstanceCreateInfo instance{};
        instance.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
        instance.pApplicationInfo = &app;
        check(vkCreateInstance(&instance, nullptr, &handles.instance), "vkCreateInstance");
        std::uint32_t one = 1;
        if (vkEnumeratePhysicalDevices(handles.instance, &one, &handles.physical_device) < VK_SUCCESS || one == 0)
            throw std::runtime_error("no Vulkan device");
        std::uint32_t n = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(handles.physical_device, &n, nullptr);
        std::vector<VkQueueFamilyProperties> families(n);
        vkGetPhysicalDeviceQueueFamilyProperties(handles.physical_device, &n, families.data());
        while ((families.at(handles.queue_family).queueFlags & VK_QUEUE_COMPUTE_BIT) == 0)
            ++handles.queue_family;
        const float priority = 1;
        VkDeviceQueueCreateInfo queue{};
        queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        queue.queueFamilyIndex = handles.queue_family;
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        VkDeviceCreateInfo device{};
        device.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
        device.queueCreateInfoCount = 1;
        device.pQueueCreateInfos = &queue;
        check(vkCreateDevice(handles.physical_device, &device, nullptr, &handles.device), "vkCreateDevice");
        vkGetDeviceQueue(handles.device, handles.queue_family, 0, &handles.queue);
        VkCommandPoolCreateInfo commands{};
        commands.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        commands.queueFamilyIndex = handles.queue_family;
        check(vkCreateCommandPool(handles.device, &commands, nullptr, &pool), "vkCreateCommandPool");
    }
    application(const application&) = delete;
    application& operator=(const application&) = delete;
    ~application()
    {
        vkDestroyCommandPool(handles.device, pool, nullptr);
        vkDestroyDevice(handles.device, nullptr);
        vkDestroyInstance(handles.instance, nullptr);
    }

    struct memory_buffer {
        VkDevice device = VK_NULL_HANDLE;
        VkBuffer buffer = VK_NULL_HANDLE;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        void* seen = nullptr; ///< the memory as mapped for the host
        memory_buffer() = default;
        memory_buffer(const memory_buffer&) = delete;
        memory_buffer& operator=(const memory_buffer&) = delete;
        ~memory_buffer()
        {
            vkDestroyBuffer(device, buffer, nullptr);
            vkFreeMemory(device, memory, nullptr);
        }
    };
    void make(memory_buffer& b, VkDeviceSize bytes, VkBufferUsageFlags usage)
    {
        b.device = handles.device;
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = bytes;
        info.usage = usage;
        check(vkCreateBuffer(handles.device, &info, nullptr, &b.buffer), "vkCreateBuffer");
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(handles.device, b.buffer, &needs);
        VkPhysicalDeviceMemoryProperties types;
        vkGetPhysicalDeviceMemoryProperties(handles.physical_device, &types);
        VkMemoryAllocateInfo memory{};
        memory.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        memory.allocationSize = needs.size;
        constexpr VkMemoryPropertyFlags properties
            = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        while (((needs.memoryTypeBits >> memory.memoryTypeIndex) & 1u) == 0
            || (types.memoryTypes[memory.memoryTypeIndex].propertyFlags & properties) != properties)
            ++memory.memoryTypeIndex;
        check(vkAllocateMemory(handles.device, &memory, nullptr, &b.memory), "vkAllocateMemory");
        check(vkBindBufferMemory(handles.device, b.buffer, b.memory, 0), "vkBindBufferMemory");
        check(vkMapMemory(handles.device, b.memory, 0, VK_WHOLE_SIZE, 0, &b.seen), "vkMapMemory");
    }
    /// Submits commands of the program's own, without waiting for them.
    void submit_copy(VkBuffer from, VkBuffer to, VkDeviceSize bytes)
    {
        VkCommandBufferAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        info.commandPool = pool;
        info.commandBufferCount = 1;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        check(vkAllocateCommandBuffers(handles.device, &info, &commands), "vkAllocateCommandBuffers");
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
        const VkBufferCopy all{0, 0, bytes};
        vkCmdCopyBuffer(commands, from, to, 1, &all);
        check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
        VkSubmitInfo submit{};
        submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &commands;
        check(vkQueueSubmit(handles.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    }
};

} // namespace

int main()
try {
    application app;
    constexpr VkDeviceSize bytes = 4 * sizeof(glm::uvec2);
    application::memory_buffer keys, result;
    app.make(keys, bytes, photongrid::vulkan_backend::adopted_usage);
    app.make(result, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    constexpr std::uint32_t pairs[] = {30, 0, 10, 1, 20, 2, 10, 3};
    std::memcpy(keys.seen, pairs, sizeof pairs);
    {
        photongrid::vulkan_backend backend(app.handles);
        auto buffer = backend.adopt<glm::uvec2>(keys.buffer, 4); // a buffer over the program's
        photongrid::bitonic_sort(backend, buffer);
        app.submit_copy(backend.handle(buffer), result.buffer, bytes); // the program's own commands, after the sort
        vkQueueWaitIdle(app.handles.queue);
    }
    const auto* sorted = static_cast<const std::uint32_t*>(result.seen);
    for (std::size_t i = 0; i < 4; ++i)
        std::cout << sorted[2 * i] << " -> " << sorted[2 * i + 1] << '\n'; // 10 -> 1, 10 -> 3, 20 -> 2, 30 -> 0
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
}
