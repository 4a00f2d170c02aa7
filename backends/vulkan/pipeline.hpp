// A compute pipeline with its bindings.
#pragma once

#include <photongrid/backends/vulkan/memory.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace photongrid::vulkan {

/// Bindings of a kernel: its inputs, its outputs and states, and what a verb has of its own (compute_prelude.glsl).
inline constexpr std::uint32_t max_inputs = 10, max_outputs = 8, first_output = max_inputs,
                               first_own = first_output + max_outputs;

/// A binding of a buffer, and its type.
struct binding {
    std::uint32_t number = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
};

/// A compute pipeline, and its bindings in the order of the buffers that are passed to it.
class pipeline {
public:
    /// `cache` may be null.
    pipeline(const context& c, VkPipelineCache cache, std::span<const std::uint32_t> spirv,
        std::vector<binding> bindings, const std::string& name)
        : device_(c.device()), bindings_(std::move(bindings))
    {
        const auto limit = c.properties().limits.maxPerStageDescriptorStorageBuffers;
        const auto needed = static_cast<std::size_t>(std::count_if(bindings_.begin(), bindings_.end(),
            [](const auto& b) { return b.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER; }));
        if (needed > limit)
            throw backend_error("vulkan: kernel '" + name + "' needs " + std::to_string(needed)
                + " storage buffers in one pass; this device (" + c.properties().deviceName + ") binds "
                + std::to_string(limit) + " at most");
        try {
            create(cache, spirv, name);
        } catch (...) {
            destroy();
            throw;
        }
    }
    pipeline(const pipeline&) = delete;
    pipeline& operator=(const pipeline&) = delete;
    ~pipeline() { destroy(); }

    VkPipeline get() const { return pipeline_; }
    VkPipelineLayout layout() const { return layout_; }
    VkDescriptorSetLayout set_layout() const { return set_layout_; }
    std::span<const binding> bindings() const { return bindings_; }

    /// Every pipeline uses the number of bytes of push constants that all devices support.
    static constexpr std::uint32_t push_bytes = 128;

private:
    void create(VkPipelineCache cache, std::span<const std::uint32_t> spirv, const std::string& name)
    {
        std::vector<VkDescriptorSetLayoutBinding> slots;
        for (const auto& b : bindings_) {
            VkDescriptorSetLayoutBinding s{};
            s.binding = b.number;
            s.descriptorType = b.type;
            s.descriptorCount = 1;
            s.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
            slots.push_back(s);
        }
        VkDescriptorSetLayoutCreateInfo set{};
        set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        set.bindingCount = static_cast<std::uint32_t>(slots.size());
        set.pBindings = slots.data();
        check(vkCreateDescriptorSetLayout(device_, &set, nullptr, &set_layout_),
            "vkCreateDescriptorSetLayout for kernel '" + name + "'");

        VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes};
        VkPipelineLayoutCreateInfo layout{};
        layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &set_layout_;
        layout.pushConstantRangeCount = 1;
        layout.pPushConstantRanges = &push;
        check(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_),
            "vkCreatePipelineLayout for kernel '" + name + "'");

        VkShaderModuleCreateInfo module_info{};
        module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        module_info.codeSize = spirv.size_bytes();
        module_info.pCode = spirv.data();
        VkShaderModule module_ = VK_NULL_HANDLE;
        check(vkCreateShaderModule(device_, &module_info, nullptr, &module_),
            "vkCreateShaderModule for kernel '" + name + "'");
        VkComputePipelineCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.module = module_;
        info.stage.pName = "main";
        info.layout = layout_;
        const VkResult r = vkCreateComputePipelines(device_, cache, 1, &info, nullptr, &pipeline_);
        vkDestroyShaderModule(device_, module_, nullptr);
        check(r, "vkCreateComputePipelines for kernel '" + name + "'");
    }
    void destroy()
    {
        vkDestroyPipeline(device_, pipeline_, nullptr);
        vkDestroyPipelineLayout(device_, layout_, nullptr);
        vkDestroyDescriptorSetLayout(device_, set_layout_, nullptr);
    }
    VkDevice device_;
    std::vector<binding> bindings_;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

} // namespace photongrid::vulkan
