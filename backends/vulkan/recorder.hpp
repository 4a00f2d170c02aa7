// Records passes and submits many at once: command buffers, descriptor sets, and the resources that must live until the
// device is done.
#pragma once

#include <photongrid/backends/vulkan/memory.hpp>

#include <array>
#include <cstring>
#include <deque>
#include <span>

namespace photongrid::vulkan_detail {

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

/// Records operations and submits them in batches. Every operation sees the results of all earlier ones.
class recorder {
public:
    /// `timed`: measure passes.
    /// \throws backend_error if the device has no timestamps.
    explicit recorder(std::shared_ptr<context> c, bool timed) : context_(std::move(c)), timed_(timed)
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
    recorder(const recorder&) = delete;
    recorder& operator=(const recorder&) = delete;
    ~recorder()
    {
        try {
            finish();
        } catch (...) { // the device was lost: nothing to wait for
        }
        for (auto* list : {&flying_, &idle_})
            for (auto& b : *list)
                destroy(b);
        if (recording_)
            destroy(now_);
        vkDestroyCommandPool(context_->device(), commands_, nullptr);
    }

    /// A pass with a given number of workgroups. `push`: the launch header and the parameters. If passes are timed, its
    /// time is added to `ms` when it is done.
    void dispatch(const pipeline& p, std::span<const memory> buffers, std::span<const std::byte> push,
        std::uint64_t groups, double& ms)
    {
        const auto most = context_->properties().limits.maxComputeWorkGroupCount[0];
        const auto rows = (groups + most - 1) / most;
        const auto columns = rows == 0 ? 0 : (groups + rows - 1) / rows;
        if (rows > context_->properties().limits.maxComputeWorkGroupCount[1])
            throw backend_error("vulkan: a pass needs " + std::to_string(groups)
                + " workgroups; this device dispatches "
                + std::to_string(std::uint64_t{most} * context_->properties().limits.maxComputeWorkGroupCount[1])
                + " at most");
        const auto c = bind(p, buffers, push);
        const timing t(*this, ms);
        vkCmdDispatch(c, static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows), 1);
        t.end();
        counted();
    }

    /// A pass with the number of workgroups that the device has written at `offset` (bytes) of `groups`.
    void dispatch_indirect(const pipeline& p, std::span<const memory> buffers, std::span<const std::byte> push,
        const memory& groups, VkDeviceSize offset, double& ms)
    {
        const auto c = bind(p, buffers, push);
        const timing t(*this, ms);
        vkCmdDispatchIndirect(c, groups->buffer(), offset);
        t.end();
        counted();
    }

    void fill(const memory& m, VkDeviceSize offset, VkDeviceSize bytes, std::uint32_t word)
    {
        const auto c = begin(m);
        vkCmdFillBuffer(c, m->buffer(), offset, bytes, word);
        counted();
    }

    void copy(
        const memory& from, VkDeviceSize from_offset, const memory& to, VkDeviceSize to_offset, VkDeviceSize bytes)
    {
        const auto c = begin(from, to);
        const VkBufferCopy region{from_offset, to_offset, bytes};
        vkCmdCopyBuffer(c, from->buffer(), to->buffer(), 1, &region);
        counted();
    }

    /// Writes from the host into new memory, which no pass has used yet.
    void write(const memory& to, const void* data, std::size_t bytes)
    {
        if (bytes == 0)
            return;
        if (to->mapped()) {
            std::memcpy(to->mapped(), data, bytes);
            return;
        }
        const auto staged = std::make_shared<allocation>(context_, bytes, memory_kind::host);
        std::memcpy(staged->mapped(), data, bytes);
        copy(staged, 0, to, 0, bytes);
    }

    /// Waits for all passes and reads the first `bytes` bytes.
    void read(const memory& from, void* data, std::size_t bytes)
    {
        if (bytes == 0)
            return;
        auto seen = from;
        if (!from->mapped()) {
            seen = std::make_shared<allocation>(context_, bytes, memory_kind::host);
            copy(from, 0, seen, 0, bytes);
        }
        finish();
        std::memcpy(data, seen->mapped(), bytes);
    }

    /// Submits the recorded operations, and from now on synchronises with the caller's commands on the queue: commands
    /// that the caller submits later see our results, and our later passes see theirs.
    void take_turns()
    {
        taking_turns_ = true;
        if (!recording_) {
            start(); // begins with the barrier
            recording_ = true;
        } else {
            full_barrier();
        }
        submit();
    }

    /// Submits the recorded operations.
    void submit()
    {
        if (!recording_)
            return;
        barrier(VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
        recording_ = false;
        flying_.push_back(std::move(now_));
        batch& b = flying_.back();
        VkResult r = vkEndCommandBuffer(b.commands);
        if (r == VK_SUCCESS) {
            VkSubmitInfo info{};
            info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
            info.commandBufferCount = 1;
            info.pCommandBuffers = &b.commands;
            r = vkQueueSubmit(context_->queue(), 1, &info, b.fence);
        }
        if (r != VK_SUCCESS) {
            destroy(b);
            flying_.pop_back();
            check(r, "submitting passes");
        }
        while (!flying_.empty()
            && (flying_.size() > most_flying
                || vkGetFenceStatus(context_->device(), flying_.front().fence) == VK_SUCCESS))
            retire();
    }

    /// Waits until everything recorded so far is done.
    void finish()
    {
        submit();
        while (!flying_.empty())
            retire();
    }

private:
    static constexpr std::uint32_t passes_per_batch = 64;
    static constexpr std::uint32_t buffers_per_pass = 20; // 8 inputs, 8 outputs, 4 for verbs
    static constexpr std::uint32_t inputs_per_pass = 8;
    static constexpr std::size_t most_flying = 4;

    struct batch {
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
        VkDescriptorPool sets = VK_NULL_HANDLE;
        std::uint32_t passes = 0;
        std::vector<memory> kept;
        VkQueryPool clock = VK_NULL_HANDLE; ///< two queries per timed pass
        std::vector<double*> timed;         ///< the destinations of the passes' times
    };

    /// Timestamps before and after a pass.
    class timing {
    public:
        timing(recorder& r, double& ms) : r_(r)
        {
            if (!r.timed_)
                return;
            r.now_.timed.push_back(&ms);
            stamp(0);
        }
        void end() const
        {
            if (r_.timed_)
                stamp(1);
        }

    private:
        void stamp(std::uint32_t which) const
        {
            vkCmdWriteTimestamp(r_.now_.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, r_.now_.clock,
                2 * (static_cast<std::uint32_t>(r_.now_.timed.size()) - 1) + which);
        }
        recorder& r_;
    };

    template <class... M>
    VkCommandBuffer begin(const M&... used)
    {
        if (!recording_) {
            start();
            recording_ = true;
        }
        (now_.kept.push_back(used), ...);
        barrier(
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT
                | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
        return now_.commands;
    }

    VkCommandBuffer bind(const pipeline& p, std::span<const memory> buffers, std::span<const std::byte> push)
    {
        const auto c = begin();
        VkDescriptorSetAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
        info.descriptorPool = now_.sets;
        info.descriptorSetCount = 1;
        const auto set_layout = p.set_layout();
        info.pSetLayouts = &set_layout;
        VkDescriptorSet set = VK_NULL_HANDLE;
        check(vkAllocateDescriptorSets(context_->device(), &info, &set), "vkAllocateDescriptorSets");
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
            now_.kept.push_back(buffers[i]);
        }
        vkUpdateDescriptorSets(
            context_->device(), static_cast<std::uint32_t>(buffers.size()), writes.data(), 0, nullptr);
        vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_COMPUTE, p.get());
        vkCmdBindDescriptorSets(c, VK_PIPELINE_BIND_POINT_COMPUTE, p.layout(), 0, 1, &set, 0, nullptr);
        std::array<std::byte, pipeline::push_bytes> bytes{};
        std::copy(push.begin(), push.end(), bytes.begin());
        vkCmdPushConstants(c, p.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, pipeline::push_bytes, bytes.data());
        return c;
    }

    void barrier(VkPipelineStageFlags stages, VkAccessFlags reads)
    {
        VkMemoryBarrier b{};
        b.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        b.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
        b.dstAccessMask = reads;
        vkCmdPipelineBarrier(now_.commands,
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
            stages, 0, 1, &b, 0, nullptr, 0, nullptr);
    }

    /// A barrier between our commands and the caller's on the queue.
    void full_barrier()
    {
        VkMemoryBarrier b{};
        b.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        b.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
        b.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        vkCmdPipelineBarrier(now_.commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
            1, &b, 0, nullptr, 0, nullptr);
    }

    void counted()
    {
        if (++now_.passes >= passes_per_batch)
            submit();
    }

    void start()
    {
        if (!idle_.empty()) {
            now_ = std::move(idle_.back());
            idle_.pop_back();
        } else {
            now_ = batch{};
            try {
                create(now_);
            } catch (...) {
                destroy(now_);
                throw;
            }
        }
        VkCommandBufferBeginInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        const VkResult r = vkBeginCommandBuffer(now_.commands, &info);
        if (r != VK_SUCCESS)
            destroy(now_);
        check(r, "vkBeginCommandBuffer");
        if (taking_turns_)
            full_barrier();
        if (timed_)
            vkCmdResetQueryPool(now_.commands, now_.clock, 0, 2 * passes_per_batch);
    }

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
                {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, passes_per_batch * inputs_per_pass}};
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

    /// Waits for the oldest batch and makes its resources available again.
    void retire()
    {
        batch b = std::move(flying_.front());
        flying_.pop_front();
        const auto device = context_->device();
        VkResult r = vkWaitForFences(device, 1, &b.fence, VK_TRUE, UINT64_MAX);
        if (r == VK_SUCCESS)
            r = vkResetFences(device, 1, &b.fence);
        if (r == VK_SUCCESS)
            r = vkResetDescriptorPool(device, b.sets, 0);
        std::vector<std::uint64_t> ticks(2 * b.timed.size());
        if (r == VK_SUCCESS && !ticks.empty())
            r = vkGetQueryPoolResults(device, b.clock, 0, static_cast<std::uint32_t>(ticks.size()),
                ticks.size() * sizeof(std::uint64_t), ticks.data(), sizeof(std::uint64_t),
                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        if (r != VK_SUCCESS) {
            destroy(b);
            check(r, "waiting for passes");
        }
        for (std::size_t t = 0; t < b.timed.size(); ++t)
            *b.timed[t] += static_cast<double>(ticks[2 * t + 1] - ticks[2 * t])
                * static_cast<double>(context_->properties().limits.timestampPeriod) * 1e-6;
        b.timed.clear();
        b.kept.clear();
        b.passes = 0;
        idle_.push_back(std::move(b));
    }

    std::shared_ptr<context> context_;
    bool timed_;
    VkCommandPool commands_ = VK_NULL_HANDLE;
    bool recording_ = false;
    bool taking_turns_ = false;
    batch now_;
    std::deque<batch> flying_, idle_;
};

} // namespace photongrid::vulkan_detail
