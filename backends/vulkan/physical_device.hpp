// What is known of each physical device, and the choice of one.
#pragma once

#include <photongrid/backends/vulkan/instance.hpp>
#include <photongrid/backends/vulkan/options.hpp>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace photongrid {

namespace vulkan {
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

    /// The rank of a device's type, from 4 for discrete to 0 for CPU.
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
} // namespace vulkan

/// All Vulkan devices, usable or not.
/// \throws backend_error, which says what to install, if there is no driver.
inline std::vector<vulkan_device_info> vulkan_devices()
{
    const vulkan::instance in(false);
    std::vector<vulkan_device_info> all;
    for (const auto d : in.physical_devices())
        all.push_back(vulkan::describe(d, static_cast<std::uint32_t>(all.size())));
    return all;
}

} // namespace photongrid
