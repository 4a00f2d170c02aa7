// Batches of passes: the Vulkan objects that a batch needs until the device is done with it.
#pragma once

#include <photongrid/backends/vulkan/pipeline.hpp>

#include <array>
#include <deque>
#include <span>
#include <vector>

namespace photongrid::vulkan {

/// A batch has room for so many passes of so many buffers.
inline constexpr std::uint32_t passes_per_batch = 64;
inline constexpr std::uint32_t buffers_per_pass = first_own + 4; // 4 for verbs

/// A batch of at most passes_per_batch passes.
struct batch {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkDescriptorPool sets = VK_NULL_HANDLE;
    std::uint32_t passes = 0;
    std::vector<memory> kept;
    VkQueryPool clock = VK_NULL_HANDLE; ///< two queries per timed pass
    std::vector<double*> timed;         ///< the destinations of the passes' times
};

/// A descriptor set of the batch with these buffers, for a pass with pipeline `p`. The batch keeps the buffers.
inline VkDescriptorSet write_set(VkDevice device, batch& b, const pipeline& p, std::span<const memory> buffers)
{
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = b.sets;
    info.descriptorSetCount = 1;
    const auto set_layout = p.set_layout();
    info.pSetLayouts = &set_layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    check(vkAllocateDescriptorSets(device, &info, &set), "vkAllocateDescriptorSets");
    std::array<VkDescriptorBufferInfo, buffers_per_pass> what{};
    std::array<VkBufferView, buffers_per_pass> views{};
    std::array<VkWriteDescriptorSet, buffers_per_pass> writes{};
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        what[i] = {buffers[i]->buffer(), 0, buffers[i]->range()};
        writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[i].dstSet = set;
        writes[i].dstBinding = p.bindings()[i].number;
        writes[i].descriptorCount = 1;
        writes[i].descriptorType = p.bindings()[i].type;
        writes[i].pBufferInfo = &what[i];
        if (writes[i].descriptorType == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) {
            views[i] = buffers[i]->view();
            writes[i].pTexelBufferView = &views[i];
        }
        b.kept.push_back(buffers[i]);
    }
    vkUpdateDescriptorSets(device, static_cast<std::uint32_t>(buffers.size()), writes.data(), 0, nullptr);
    return set;
}

/// Makes batches, and keeps those that the device is done with for later passes.
class batch_pool {
public:
    /// `timed`: batches have queries for the times of their passes.
    /// \throws backend_error if the device has no timestamps.
    batch_pool(std::shared_ptr<context> c, bool timed) : context_(std::move(c)), timed_(timed)
    {
        if (timed && timestamp_bits(context_->physical(), context_->family()) == 0)
            throw backend_error(std::string("vulkan: time_passes: ") + context_->properties().deviceName
                + " has no timestamps on its compute queue");
        VkCommandPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        info.queueFamilyIndex = context_->family();
        check(vkCreateCommandPool(context_->device(), &info, nullptr, &commands_), "vkCreateCommandPool");
    }
    batch_pool(const batch_pool&) = delete;
    batch_pool& operator=(const batch_pool&) = delete;
    ~batch_pool()
    {
        for (auto& b : idle_)
            destroy(b);
        vkDestroyCommandPool(context_->device(), commands_, nullptr);
    }

    /// An empty batch.
    batch take()
    {
        batch b;
        if (!idle_.empty()) {
            b = std::move(idle_.back());
            idle_.pop_back();
            return b;
        }
        try {
            create(b);
        } catch (...) {
            destroy(b);
            throw;
        }
        return b;
    }

    /// Returns an idle batch to the pool.
    void give_back(batch&& b)
    {
        b.timed.clear();
        b.kept.clear();
        b.passes = 0;
        idle_.push_back(std::move(b));
    }

    void destroy(batch& b) const
    {
        b.kept.clear();
        vkDestroyQueryPool(context_->device(), b.clock, nullptr);
        vkDestroyDescriptorPool(context_->device(), b.sets, nullptr);
        vkDestroyFence(context_->device(), b.fence, nullptr);
        if (b.commands)
            vkFreeCommandBuffers(context_->device(), commands_, 1, &b.commands);
        b = batch{};
    }

private:
    void create(batch& b) const
    {
        VkCommandBufferAllocateInfo commands{};
        commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        commands.commandPool = commands_;
        commands.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        commands.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(context_->device(), &commands, &b.commands), "vkAllocateCommandBuffers");
        VkFenceCreateInfo fence{};
        fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        check(vkCreateFence(context_->device(), &fence, nullptr, &b.fence), "vkCreateFence");
        constexpr VkDescriptorPoolSize sizes[]
            = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, passes_per_batch * buffers_per_pass},
                {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, passes_per_batch * max_inputs}};
        VkDescriptorPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
        pool.maxSets = passes_per_batch;
        pool.poolSizeCount = 2;
        pool.pPoolSizes = sizes;
        check(vkCreateDescriptorPool(context_->device(), &pool, nullptr, &b.sets), "vkCreateDescriptorPool");
        if (timed_) {
            VkQueryPoolCreateInfo clock{};
            clock.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
            clock.queryType = VK_QUERY_TYPE_TIMESTAMP;
            clock.queryCount = 2 * passes_per_batch;
            check(vkCreateQueryPool(context_->device(), &clock, nullptr, &b.clock), "vkCreateQueryPool");
        }
    }

    std::shared_ptr<context> context_;
    bool timed_;
    VkCommandPool commands_ = VK_NULL_HANDLE;
    std::deque<batch> idle_;
};

} // namespace photongrid::vulkan
