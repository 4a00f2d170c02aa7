// Compiles kernels, and caches their SPIR-V and the driver's pipelines.
#pragma once

#include <photongrid/backends/vulkan/file_cache.hpp>
#include <photongrid/backends/vulkan/memory.hpp>
#include <photongrid/backends/vulkan/spirv.hpp>

#include <glslang/build_info.h>
#include <spirv-tools/libspirv.h>

namespace photongrid::vulkan {

class compiled_kernels {
public:
    /// `folder`: cache folder; "": none. `optimized`: run the SPIR-V optimizer.
    compiled_kernels(std::shared_ptr<context> c, const std::string& folder, bool optimized)
        : context_(std::move(c)), cache_(folder), optimized_(optimized)
    {
        if (folder.empty())
            return;
        const auto& p = context_->properties();
        drivers_key_ = "pipelines " + std::to_string(p.vendorID) + " " + std::to_string(p.deviceID) + " "
            + std::to_string(p.driverVersion) + " ";
        for (const auto byte : p.pipelineCacheUUID)
            drivers_key_ += std::to_string(byte) + ".";
        kept_ = cache_.find(drivers_key_).value_or(file_cache::bytes{});
        VkPipelineCacheCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
        info.initialDataSize = kept_.size();
        info.pInitialData = kept_.data();
        if (vkCreatePipelineCache(context_->device(), &info, nullptr, &drivers_) != VK_SUCCESS)
            drivers_ = VK_NULL_HANDLE; // continue without the driver's cache
    }
    compiled_kernels(const compiled_kernels&) = delete;
    compiled_kernels& operator=(const compiled_kernels&) = delete;
    ~compiled_kernels()
    {
        if (drivers_ == VK_NULL_HANDLE)
            return;
        std::size_t size = 0;
        if (vkGetPipelineCacheData(context_->device(), drivers_, &size, nullptr) == VK_SUCCESS) {
            file_cache::bytes now(size);
            if (vkGetPipelineCacheData(context_->device(), drivers_, &size, now.data()) == VK_SUCCESS && now != kept_)
                try {
                    cache_.keep(drivers_key_, std::string_view(now.data(), size));
                } catch (const std::bad_alloc&) { // continue without storing it
                }
        }
        vkDestroyPipelineCache(context_->device(), drivers_, nullptr);
    }

    /// compile_spirv(), unless the cache has the same text compiled by the same tools.
    spirv_words compile(const spliced_source& source, const std::string& name)
    {
        static const std::string tools = "SPIR-V by photongrid 1, glslang " + std::to_string(GLSLANG_VERSION_MAJOR)
            + "." + std::to_string(GLSLANG_VERSION_MINOR) + "." + std::to_string(GLSLANG_VERSION_PATCH)
            + ", SPIRV-Tools " + spvSoftwareVersionString() + "\n";
        const std::string key = (optimized_ ? tools : "plain " + tools) + source.text;
        if (const auto found = cache_.find(key);
            found && !found->empty() && found->size() % sizeof(std::uint32_t) == 0) {
            spirv_words words(found->size() / sizeof(std::uint32_t));
            std::memcpy(words.data(), found->data(), found->size());
            ++found_;
            return words;
        }
        auto words = compile_spirv(source, name, optimized_);
        cache_.keep(
            key, std::string_view(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t)));
        return words;
    }

    /// The driver's pipeline cache; null without a folder.
    VkPipelineCache drivers() const { return drivers_; }
    std::uint64_t found() const { return found_; }

private:
    std::shared_ptr<context> context_;
    file_cache cache_;
    bool optimized_;
    std::string drivers_key_;
    file_cache::bytes kept_;
    VkPipelineCache drivers_ = VK_NULL_HANDLE;
    std::uint64_t found_ = 0;
};

} // namespace photongrid::vulkan
