// A Vulkan instance, with the messages of the validation layer.
#pragma once

#include <photongrid/backends/vulkan/errors.hpp>

#include <algorithm>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace photongrid::vulkan {

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
        check_loader();
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
        constexpr VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT,
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
            throw backend_error("vulkan: vkCreateInstance: " + result_name(r) + "; the loader searched for drivers in "
                + driver_search_paths() + ". " + install_hint);
        owned_ = true;
        if (validation)
            listen(messenger);
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
    /// \throws backend_error if the loader is too old.
    static void check_loader()
    {
        std::uint32_t version = VK_API_VERSION_1_0;
        if (const auto f = reinterpret_cast<PFN_vkEnumerateInstanceVersion>(
                vkGetInstanceProcAddr(nullptr, "vkEnumerateInstanceVersion")))
            f(&version);
        if (version < VK_API_VERSION_1_1)
            throw backend_error("vulkan: the loader supports Vulkan 1.0 only; 1.1 is needed. Update it (Debian: apt "
                                "install libvulkan1)");
    }
    void listen(const VkDebugUtilsMessengerCreateInfoEXT& messenger)
    {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(handle_, "vkCreateDebugUtilsMessengerEXT"));
        if (create)
            create(handle_, &messenger, nullptr, &messenger_);
    }
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

} // namespace photongrid::vulkan
