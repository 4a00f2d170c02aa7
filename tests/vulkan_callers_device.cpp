// A program that has a Vulkan device already: photongrid works on it, takes over its buffers and hands over its own,
// and the validation layer, synchronization included, has nothing to say.
#include "on_serial.hpp"
#include "photon_sets.hpp"
#include "under_test.hpp"

#include <photongrid/backends/vulkan/overrides/all.hpp>
#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/knn_grid_estimate.hpp>

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
        handles.queue_family = vulkan_detail::compute_family(handles.physical_device).value();
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

TEST_F(callers_device, gives_what_serial_gives_and_stays_the_callers)
{
    const auto s = make_photons(distribution::uniform, 1000, glm::uvec3(5), 1);
    const auto points = make_points(s, 100, 1);
    const auto estimates = [&](auto& b) {
        const auto map = sorted_map(b, upload_photons(b, s), s.g);
        return b.download(
            knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), {.k = 20, .max_radius = 1.0f})
                .irradiance);
    };
    {
        vulkan_backend mine(app.handles);
        EXPECT_EQ(count_different_bits(estimates(mine), estimates(serial)), 0u);
    }
    app.wait();
}

TEST_F(callers_device, takes_over_a_buffer_and_hands_one_back_without_the_host)
{
    constexpr std::size_t n = 5000;
    constexpr VkDeviceSize bytes = n * sizeof(uvec2);
    const auto pairs = random_pairs(n);
    application::own_buffer source, keys, result;
    app.make(source, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    app.make(keys, bytes, vulkan_backend::adopted_usage);
    app.make(result, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    source.fill(pairs);
    const auto to_keys = app.record_copy(source.buffer, keys.buffer, bytes);
    {
        vulkan_backend b(app.handles);
        const auto held = b.bytes();
        auto buffer = b.adopt<uvec2>(keys.buffer, n);
        EXPECT_EQ(buffer.size(), n);
        EXPECT_EQ(b.bytes(), held);
        app.submit(to_keys); // nobody waits: the sort comes after it on the queue
        bitonic_sort(b, buffer);
        app.submit(app.record_copy(b.handle(buffer), result.buffer, bytes));
        app.wait();
        EXPECT_EQ(result.contents<uvec2>(), in_order(pairs));
        EXPECT_EQ(b.download(buffer), in_order(pairs));
    }
    app.wait();
    EXPECT_EQ(keys.contents<uvec2>().size(), n); // still the application's
}

TEST_F(callers_device, sees_in_its_own_buffer_what_a_pass_wrote_there)
{
    constexpr uint n = 1000;
    application::own_buffer ids, result;
    app.make(ids, n * sizeof(uint), vulkan_backend::adopted_usage);
    app.make(result, n * sizeof(uint), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    vulkan_backend b(app.handles);
    const auto pairs = random_pairs(n);
    const auto from = b.upload(std::span<const uvec2>(pairs));
    auto adopted = b.adopt<uint>(ids.buffer, n);
    for (uint turn = 0; turn < 3; ++turn) { // their copy reads what ours wrote, ours writes what theirs has read
        b.run<kernels::pair_value>(n, {}, reads(from), writes(adopted));
        ASSERT_EQ(b.handle(adopted), ids.buffer);
        app.submit(app.record_copy(ids.buffer, result.buffer, n * sizeof(uint)));
    }
    app.wait();
    const auto seen = result.contents<uint>();
    for (uint i = 0; i < n; ++i)
        ASSERT_EQ(seen[i], pairs[i].y);
}

TEST_F(callers_device, owns_a_buffer_that_was_released)
{
    vulkan_backend::released_buffer given;
    application::own_buffer result;
    const auto pairs = random_pairs(100);
    app.make(result, 100 * sizeof(uvec2), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    {
        vulkan_backend b(app.handles);
        const auto held = b.bytes();
        auto buffer = b.upload(std::span<const uvec2>(pairs));
        EXPECT_GT(b.bytes(), held);
        given = b.release(std::move(buffer));
        EXPECT_EQ(b.bytes(), held);
        EXPECT_EQ(buffer.size(), 0u);
    }
    ASSERT_NE(given.buffer, VkBuffer{});
    app.submit(app.record_copy(given.buffer, result.buffer, 100 * sizeof(uvec2)));
    app.wait();
    EXPECT_EQ(result.contents<uvec2>(), pairs);
    vkDestroyBuffer(app.handles.device, given.buffer, nullptr);
    vkFreeMemory(app.handles.device, given.memory, nullptr);
}

TEST_F(callers_device, is_refused_what_cannot_be)
{
    EXPECT_THROW(vulkan_backend{vulkan_handles{}}, std::invalid_argument);
    vulkan_backend b(app.handles), other(app.handles);
    EXPECT_THROW((void)b.adopt<uint>(VK_NULL_HANDLE, 10), std::invalid_argument);
    application::own_buffer small;
    app.make(small, 64, vulkan_backend::adopted_usage);
    EXPECT_THROW((void)b.adopt<uint>(small.buffer, 0), std::invalid_argument);
    EXPECT_THROW((void)b.adopt<uint>(small.buffer, std::size_t{1} << 40), std::invalid_argument);

    // Another backend's buffers, on the same device even.
    const auto pairs = random_pairs(8);
    auto theirs = other.upload(std::span<const uvec2>(pairs));
    auto ours = b.make<uint>(8);
    auto ids = other.make<uint>(8);
    const auto refusal = [](auto&& f) {
        try {
            f();
        } catch (const std::invalid_argument& e) {
            return std::string(e.what());
        }
        return std::string("none");
    };
    EXPECT_NE(refusal([&] {
        b.run<kernels::pair_value>(8, {}, reads(theirs), writes(ours));
    }).find("buffer 'pairs' belongs to another"),
        std::string::npos);
    EXPECT_NE(refusal([&] {
        other.run<kernels::pair_value>(8, {}, reads(theirs), writes(ours));
    }).find("buffer 'value' belongs to another"),
        std::string::npos);
    EXPECT_NE(refusal([&] { (void)b.download(theirs); }).find("download: b"), std::string::npos);
    EXPECT_NE(refusal([&] { (void)b.handle(theirs); }).find("handle: b"), std::string::npos);
    EXPECT_NE(refusal([&] { (void)b.release(std::move(ids)); }).find("release: b"), std::string::npos);
    EXPECT_EQ(refusal([&] {
        b.run<kernels::pair_value>(8, {}, reads(b.upload(std::span<const uvec2>(pairs))), writes(ours));
    }),
        "none");
}

} // namespace photongrid::testing
