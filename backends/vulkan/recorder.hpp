// Records passes and submits many at once.
#pragma once

#include <photongrid/backends/vulkan/barriers.hpp>
#include <photongrid/backends/vulkan/batch.hpp>

#include <array>
#include <cstring>
#include <deque>
#include <span>

namespace photongrid::vulkan {

/// Records operations and submits them in batches. Every operation sees the results of all earlier ones.
class recorder {
public:
    /// `timed`: measure passes.
    /// \throws backend_error if the device has no timestamps.
    explicit recorder(std::shared_ptr<context> c, bool timed)
        : context_(std::move(c)), timed_(timed), pool_(context_, timed)
    {
    }
    recorder(const recorder&) = delete;
    recorder& operator=(const recorder&) = delete;
    ~recorder()
    {
        try {
            finish();
        } catch (...) { // the device was lost: nothing to wait for
        }
        for (auto& b : flying_)
            pool_.destroy(b);
        if (recording_)
            pool_.destroy(now_);
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
        finish(); // the copy, too
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
            full_barrier(now_.commands);
        }
        submit();
    }

    /// Submits the recorded operations.
    void submit()
    {
        if (!recording_)
            return;
        barrier(now_.commands, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
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
            pool_.destroy(b);
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
    static constexpr std::size_t most_flying = 4;

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
        barrier(now_.commands,
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT
                | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
        return now_.commands;
    }

    VkCommandBuffer bind(const pipeline& p, std::span<const memory> buffers, std::span<const std::byte> push)
    {
        const auto c = begin();
        const VkDescriptorSet set = write_set(context_->device(), now_, p, buffers);
        vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_COMPUTE, p.get());
        vkCmdBindDescriptorSets(c, VK_PIPELINE_BIND_POINT_COMPUTE, p.layout(), 0, 1, &set, 0, nullptr);
        std::array<std::byte, pipeline::push_bytes> bytes{};
        std::copy(push.begin(), push.end(), bytes.begin());
        vkCmdPushConstants(c, p.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, pipeline::push_bytes, bytes.data());
        return c;
    }

    void counted()
    {
        if (++now_.passes >= passes_per_batch)
            submit();
    }

    void start()
    {
        now_ = pool_.take();
        VkCommandBufferBeginInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        const VkResult r = vkBeginCommandBuffer(now_.commands, &info);
        if (r != VK_SUCCESS)
            pool_.destroy(now_);
        check(r, "vkBeginCommandBuffer");
        if (taking_turns_)
            full_barrier(now_.commands);
        if (timed_)
            vkCmdResetQueryPool(now_.commands, now_.clock, 0, 2 * passes_per_batch);
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
            pool_.destroy(b);
            check(r, "waiting for passes");
        }
        for (std::size_t t = 0; t < b.timed.size(); ++t)
            *b.timed[t] += static_cast<double>(ticks[2 * t + 1] - ticks[2 * t])
                * static_cast<double>(context_->properties().limits.timestampPeriod) * 1e-6;
        pool_.give_back(std::move(b));
    }

    std::shared_ptr<context> context_;
    bool timed_;
    batch_pool pool_;
    bool recording_ = false;
    bool taking_turns_ = false;
    batch now_;
    std::deque<batch> flying_;
};

} // namespace photongrid::vulkan
