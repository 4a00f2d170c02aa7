// Finds and opens a Vulkan device. It uses the C API: <vulkan/vulkan_raii.hpp> takes seconds to compile in every file.
#pragma once

#include <photongrid/backends/vulkan/errors.hpp>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace photongrid {

/// Options of the Vulkan backend.
/// \headerfile backends/vulkan/vulkan.hpp <photongrid/backends/vulkan/vulkan.hpp>
struct vulkan_options {
    std::string device{}; ///< "": the best (discrete, integrated, virtual, CPU); else an index or a part of the name
    bool hardware_only = false; ///< reject devices that are a CPU
    bool validation = false;   ///< run the Khronos validation layer (core and synchronization) and collect its messages
    bool gpu_assisted = false; ///< with validation: instrument kernels, so that accesses past a buffer's end give
                               ///< messages; slow
    bool staging = false;      ///< always work as on a discrete GPU: copy through staging buffers, and read inputs as
                               ///< storage buffers
    bool subgroups = true;     ///< let neighbouring points search in a subgroup, if the device supports it
    bool time_passes = false;  ///< measure passes by the device's clock, for costs(); a little slower
    std::string cache_folder{}; ///< folder in which compiled kernels are cached; "": none
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

namespace vulkan_detail {
    /// Messages of the validation layer.
    struct message_log {
        std::mutex mutex;
        std::vector<std::string> messages;
    };

    inline VKAPI_ATTR VkBool32 VKAPI_CALL collect_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
        VkDebugUtilsMessageTypeFlagsEXT, const VkDebugUtilsMessengerCallbackDataEXT* data, void* user)
    {
        auto& log = *static_cast<message_log*>(user);
        const std::scoped_lock lock(log.mutex);
        log.messages.emplace_back(data->pMessage ? data->pMessage : "");
        return VK_FALSE;
    }

    /// An instance of the backend, or a caller's.
    class instance {
    public:
        /// \throws backend_error if there is no driver, or no validation layer although it was requested.
        explicit instance(bool validation, bool gpu_assisted = false)
        {
            std::uint32_t version = VK_API_VERSION_1_0;
            if (const auto f = reinterpret_cast<PFN_vkEnumerateInstanceVersion>(
                    vkGetInstanceProcAddr(nullptr, "vkEnumerateInstanceVersion")))
                f(&version);
            if (version < VK_API_VERSION_1_1)
                throw backend_error(
                    "vulkan: the loader supports Vulkan 1.0 only; 1.1 is needed. Update it (Debian: apt "
                    "install libvulkan1)");
            VkApplicationInfo app{};
            app.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
            app.pApplicationName = "photongrid";
            app.apiVersion = VK_API_VERSION_1_1;
            VkInstanceCreateInfo info{};
            info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
            info.pApplicationInfo = &app;
            std::vector<const char*> extensions;
            constexpr const char* portability = "VK_KHR_portability_enumeration";
            if (has_extension(nullptr, portability)) {
                extensions.push_back(portability);
                info.flags = 1; // VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR: for MoltenVK
            }

            constexpr const char* layer = "VK_LAYER_KHRONOS_validation";
            VkDebugUtilsMessengerCreateInfoEXT messenger{};
            VkValidationFeaturesEXT features{};
            // GPU-assisted validation reserves a descriptor set.
            constexpr VkValidationFeatureEnableEXT enabled[]
                = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT,
                    VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT,
                    VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT};
            if (validation) {
                if (!has_layer(layer))
                    throw backend_error(std::string("vulkan: validation was requested, but the layer ") + layer
                        + " is not installed (Debian: apt install vulkan-validationlayers)");
                extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
                if (has_extension(layer, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME))
                    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
                log_ = std::make_unique<message_log>();
                messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
                messenger.messageSeverity
                    = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
                messenger.messageType
                    = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
                messenger.pfnUserCallback = collect_message;
                messenger.pUserData = log_.get();
                features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
                features.enabledValidationFeatureCount = gpu_assisted ? 3 : 1;
                features.pEnabledValidationFeatures = enabled;
                features.pNext = &messenger;
                info.pNext = &features;
                info.enabledLayerCount = 1;
                info.ppEnabledLayerNames = &layer;
            }
            info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
            info.ppEnabledExtensionNames = extensions.data();
            const VkResult r = vkCreateInstance(&info, nullptr, &handle_);
            if (r != VK_SUCCESS)
                throw backend_error("vulkan: vkCreateInstance: " + result_name(r)
                    + "; the loader searched for drivers in " + driver_search_paths() + ". " + install_hint);
            owned_ = true;
            if (validation) {
                const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
                    vkGetInstanceProcAddr(handle_, "vkCreateDebugUtilsMessengerEXT"));
                if (create)
                    create(handle_, &messenger, nullptr, &messenger_);
            }
        }
        explicit instance(VkInstance callers) : handle_(callers) {}
        instance(const instance&) = delete;
        instance& operator=(const instance&) = delete;
        ~instance()
        {
            if (messenger_)
                if (const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
                        vkGetInstanceProcAddr(handle_, "vkDestroyDebugUtilsMessengerEXT")))
                    destroy(handle_, messenger_, nullptr);
            if (owned_)
                vkDestroyInstance(handle_, nullptr);
        }

        VkInstance get() const { return handle_; }
        std::vector<std::string> messages() const
        {
            if (!log_)
                return {};
            const std::scoped_lock lock(log_->mutex);
            return log_->messages;
        }
        std::vector<VkPhysicalDevice> physical_devices() const
        {
            std::uint32_t n = 0;
            const VkResult r = vkEnumeratePhysicalDevices(handle_, &n, nullptr);
            if (r == VK_ERROR_INITIALIZATION_FAILED) // some loaders return it if drivers find no device
                return {};
            check(r, "vkEnumeratePhysicalDevices");
            std::vector<VkPhysicalDevice> devices(n);
            if (n > 0 && vkEnumeratePhysicalDevices(handle_, &n, devices.data()) < VK_SUCCESS)
                n = 0;
            devices.resize(n);
            return devices;
        }

    private:
        static bool has_layer(const char* name)
        {
            std::uint32_t n = 0;
            vkEnumerateInstanceLayerProperties(&n, nullptr);
            std::vector<VkLayerProperties> layers(n);
            vkEnumerateInstanceLayerProperties(&n, layers.data());
            return std::any_of(
                layers.begin(), layers.end(), [&](const auto& l) { return std::strcmp(l.layerName, name) == 0; });
        }
        static bool has_extension(const char* layer, const char* name)
        {
            std::uint32_t n = 0;
            vkEnumerateInstanceExtensionProperties(layer, &n, nullptr);
            std::vector<VkExtensionProperties> extensions(n);
            vkEnumerateInstanceExtensionProperties(layer, &n, extensions.data());
            return std::any_of(extensions.begin(), extensions.end(),
                [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
        }
        std::unique_ptr<message_log> log_;
        VkInstance handle_ = VK_NULL_HANDLE;
        VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
        bool owned_ = false;
    };

    inline bool device_has_extension(VkPhysicalDevice d, const char* name)
    {
        std::uint32_t n = 0;
        vkEnumerateDeviceExtensionProperties(d, nullptr, &n, nullptr);
        std::vector<VkExtensionProperties> extensions(n);
        vkEnumerateDeviceExtensionProperties(d, nullptr, &n, extensions.data());
        return std::any_of(extensions.begin(), extensions.end(),
            [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
    }

    /// The first queue family with compute, if there is one.
    inline std::optional<std::uint32_t> compute_family(VkPhysicalDevice d)
    {
        std::uint32_t n = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(d, &n, nullptr);
        std::vector<VkQueueFamilyProperties> families(n);
        vkGetPhysicalDeviceQueueFamilyProperties(d, &n, families.data());
        for (std::uint32_t f = 0; f < n; ++f)
            if ((families[f].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0 && families[f].queueCount > 0)
                return f;
        return std::nullopt;
    }

    /// The number of valid bits of a family's timestamps; 0 if it has none.
    inline std::uint32_t timestamp_bits(VkPhysicalDevice d, std::uint32_t family)
    {
        std::uint32_t n = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(d, &n, nullptr);
        std::vector<VkQueueFamilyProperties> families(n);
        vkGetPhysicalDeviceQueueFamilyProperties(d, &n, families.data());
        return families[family].timestampValidBits;
    }

    /// The size of a subgroup, if it is the same for every shader and the device supports votes, arithmetic and
    /// shuffles; otherwise 1.
    inline std::uint32_t lanes_of_subgroups(VkPhysicalDevice d)
    {
        VkPhysicalDeviceSubgroupProperties subgroup{};
        subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
        VkPhysicalDeviceSubgroupSizeControlPropertiesEXT sizes{};
        sizes.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES_EXT;
        subgroup.pNext = &sizes;
        if (!device_has_extension(d, VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME))
            return 1;
        VkPhysicalDeviceProperties2 p{};
        p.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
        p.pNext = &subgroup;
        vkGetPhysicalDeviceProperties2(d, &p);
        constexpr VkSubgroupFeatureFlags needed
            = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
        const bool can = (subgroup.supportedOperations & needed) == needed
            && (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
        return can && sizes.minSubgroupSize == sizes.maxSubgroupSize ? subgroup.subgroupSize : 1;
    }

    /// The rank of a device's type, from 3 for discrete to 0 for CPU.
    inline int rank(VkPhysicalDeviceType t)
    {
        return t == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU  ? 4
            : t == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? 3
            : t == VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU    ? 2
            : t == VK_PHYSICAL_DEVICE_TYPE_CPU            ? 0
                                                          : 1;
    }

    inline vulkan_device_info describe(VkPhysicalDevice d, std::uint32_t index)
    {
        VkPhysicalDeviceProperties p;
        vkGetPhysicalDeviceProperties(d, &p);
        vulkan_device_info i;
        i.index = index;
        i.name = p.deviceName;
        constexpr const char* types[] = {"cpu", "other", "virtual", "integrated", "discrete"};
        i.type = types[rank(p.deviceType)];
        i.software = p.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
        i.api_version = std::to_string(VK_API_VERSION_MAJOR(p.apiVersion)) + "."
            + std::to_string(VK_API_VERSION_MINOR(p.apiVersion)) + "."
            + std::to_string(VK_API_VERSION_PATCH(p.apiVersion));
        i.max_buffer_bytes = p.limits.maxStorageBufferRange;
        i.max_storage_buffers = p.limits.maxPerStageDescriptorStorageBuffers;
        VkPhysicalDeviceMemoryProperties m;
        vkGetPhysicalDeviceMemoryProperties(d, &m);
        for (std::uint32_t h = 0; h < m.memoryHeapCount; ++h)
            if ((m.memoryHeaps[h].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0)
                i.memory_bytes = std::max<std::uint64_t>(i.memory_bytes, m.memoryHeaps[h].size);
        i.driver = "driver " + std::to_string(p.driverVersion);
        if (p.apiVersion < VK_API_VERSION_1_1) {
            i.unusable = "it supports Vulkan " + i.api_version + "; 1.1 is needed";
            return i;
        }
        if (device_has_extension(d, VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME)) {
            VkPhysicalDeviceDriverProperties driver{};
            driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
            VkPhysicalDeviceProperties2 p2{};
            p2.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
            p2.pNext = &driver;
            vkGetPhysicalDeviceProperties2(d, &p2);
            i.driver = std::string(driver.driverName) + " " + driver.driverInfo;
        }
        if (!compute_family(d))
            i.unusable = "it has no compute queue";
        return i;
    }

    inline std::string in_words(const std::vector<vulkan_device_info>& devices)
    {
        std::string text;
        for (const auto& d : devices)
            text += (text.empty() ? "" : "; ") + std::to_string(d.index) + ": " + d.name + " (" + d.type
                + (d.unusable.empty() ? "" : ", " + d.unusable) + ")";
        return text.empty() ? "none" : text;
    }

    /// The device that `options` select.
    /// \throws backend_error that lists the available devices.
    inline VkPhysicalDevice choose_device(const instance& in, const vulkan_options& options)
    {
        const auto devices = in.physical_devices();
        if (devices.empty())
            throw backend_error("vulkan: no device: drivers were found, but none has a device (searched in "
                + driver_search_paths() + "). " + install_hint);
        std::vector<vulkan_device_info> all;
        for (std::uint32_t d = 0; d < devices.size(); ++d)
            all.push_back(describe(devices[d], d));

        const auto lower = [](std::string s) {
            std::transform(
                s.begin(), s.end(), s.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
            return s;
        };
        const bool number = !options.device.empty() && options.device.size() < 6
            && std::all_of(
                options.device.begin(), options.device.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
        std::optional<std::uint32_t> best;
        int best_rank = -1;
        for (const auto& i : all) {
            VkPhysicalDeviceProperties p;
            vkGetPhysicalDeviceProperties(devices[i.index], &p);
            const bool meant = number ? std::stoul(options.device) == i.index
                                      : lower(i.name).find(lower(options.device)) != std::string::npos;
            if (!meant || !i.unusable.empty() || (options.hardware_only && i.software)
                || rank(p.deviceType) <= best_rank)
                continue;
            best = i.index;
            best_rank = rank(p.deviceType);
        }
        if (!best)
            throw backend_error("vulkan: no device"
                + (options.device.empty() ? std::string() : " '" + options.device + "'")
                + (options.hardware_only ? " that is hardware" : "") + " can be used; available: " + in_words(all)
                + (options.hardware_only ? ". Install the GPU's Vulkan driver, or allow software devices"
                                         : ". Select one of these by its index or part of its name"));
        return devices[*best];
    }

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
        explicit logical_device(const vulkan_handles& h) : handle_(h.device), queue_(h.queue), family_(h.queue_family)
        {
        }
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
} // namespace vulkan_detail

/// All Vulkan devices, usable or not.
/// \throws backend_error, which says what to install, if there is no driver.
inline std::vector<vulkan_device_info> vulkan_devices()
{
    const vulkan_detail::instance in(false);
    std::vector<vulkan_device_info> all;
    for (const auto d : in.physical_devices())
        all.push_back(vulkan_detail::describe(d, static_cast<std::uint32_t>(all.size())));
    return all;
}

} // namespace photongrid
