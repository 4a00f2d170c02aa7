// The manual's snippets of the Vulkan backend, run and checked.
#include "expect.hpp"

#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/map/prefix_sums.hpp>

#include <iostream>

namespace {

/// Why no device can be had; "": one can.
std::string refusal()
{
    try {
        const photongrid::vulkan_backend any;
        return {};
    } catch (const photongrid::backend_error& e) {
        return e.what();
    }
}

void expect_success(VkResult r, const char* what)
{
    if (r != VK_SUCCESS)
        throw std::runtime_error(std::string(what) + " failed with " + std::to_string(r));
}

/// A device with a queue for compute, as an application opens its own.
class application {
public:
    application()
    {
        VkApplicationInfo app{};
        app.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
        app.apiVersion = VK_API_VERSION_1_1;
        VkInstanceCreateInfo instance{};
        instance.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
        instance.pApplicationInfo = &app;
        expect_success(vkCreateInstance(&instance, nullptr, &handles.instance), "vkCreateInstance");
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
        expect_success(vkCreateDevice(handles.physical_device, &device, nullptr, &handles.device), "vkCreateDevice");
        vkGetDeviceQueue(handles.device, handles.queue_family, 0, &handles.queue);
    }
    application(const application&) = delete;
    application& operator=(const application&) = delete;
    ~application()
    {
        vkDestroyDevice(handles.device, nullptr);
        vkDestroyInstance(handles.instance, nullptr);
    }
    photongrid::vulkan_handles handles;
};

void snippets(const photongrid::vulkan_handles& handles)
{
    photongrid::vulkan_backend::released_buffer mine;
    const std::vector<photongrid::uint> expected{1, 3, 6, 10};
    {
        //! [callers_device]
        // handles: the VkInstance, VkPhysicalDevice, VkDevice, VkQueue and queue family that the program has already.
        photongrid::vulkan_backend device(handles);
        const auto terms = photongrid::upload(device, std::vector<photongrid::uint>{1, 2, 3, 4});
        auto sums = photongrid::prefix_sums(device, terms);
        //! [callers_device]
        expect(device.download(sums) == expected, "callers_device");

        //! [handle]
        const VkBuffer buffer = device.handle(sums); // commands submitted to the queue after this see the sums
        //! [handle]
        expect(buffer != VK_NULL_HANDLE, "handle");

        //! [release]
        mine = device.release(
            std::move(sums)); // to be ended by vkDestroyBuffer(mine.buffer) and vkFreeMemory(mine.memory)
        //! [release]
        // NOLINTNEXTLINE(bugprone-use-after-move): a released buffer is empty
        expect(mine.buffer == buffer && mine.memory != VK_NULL_HANDLE && sums.size() == 0, "release");

        //! [adopt]
        const auto again = device.adopt<photongrid::uint>(
            mine.buffer, 4); // a VkBuffer made with usage adopted_usage, without a copy
        //! [adopt]
        expect(device.download(again) == expected, "adopt");
    }
    vkDestroyBuffer(handles.device, mine.buffer, nullptr);
    vkFreeMemory(handles.device, mine.memory, nullptr);
}

} // namespace

int main()
try {
    if (const std::string why = refusal(); !why.empty()) {
        std::cerr << why << '\n';
        return 77; // ctest: skipped
    }
    {
        //! [vulkan_backend]
        photongrid::vulkan_backend device; // the best device; {.device = "llvmpipe"}: the one with that in its name
        const std::string name = device.caps().device; // the driver's words
        auto buffer = device.make<float>(1000);        // contents undefined
        //! [vulkan_backend]
        expect(!name.empty() && buffer.size() == 1000 && device.bytes() >= 4000, "vulkan_backend");
    }
    const application mine;
    snippets(mine.handles);
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
}
