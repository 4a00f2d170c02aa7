// Whether our commands are kept apart from the caller's, and from the host's reads. Software devices execute commands
// in order, and the validation layer of Debian 12 looks at one command buffer at a time, so neither shows a missing
// barrier: the calls themselves are watched.
#pragma once

#include "vulkan_caller.hpp"

#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <map>
#include <set>

namespace photongrid::testing {
namespace {

    /// What this program records and submits: the functions of the same names at the end of this file.
    struct command_watch {
        /// A command that works on buffers, or a barrier.
        struct command {
            VkCommandBuffer in = VK_NULL_HANDLE;
            bool is_barrier = false;
            VkPipelineStageFlags from = 0, to = 0;
            VkAccessFlags writes = 0, reads = 0;
            std::size_t submission = 0;

            bool connects(VkPipelineStageFlags before, VkAccessFlags written, VkPipelineStageFlags after,
                VkAccessFlags read) const
            {
                return is_barrier && (from & before) == before && (writes & written) == written && (to & after) == after
                    && (reads & read) == read;
            }
            /// Between commands of any kind: the caller's are unknown, so nothing narrower will do.
            bool connects_all() const
            {
                return connects(VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                    VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
            }
            /// Between our passes and copies, and the host once it has waited for them.
            bool shows_the_host() const
            {
                return connects(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                    VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                    VK_ACCESS_HOST_READ_BIT);
            }
        };
        static inline std::map<VkCommandBuffer, std::vector<command>> recorded;
        static inline std::vector<command> submitted; ///< by queue submissions, in their order
        static inline std::size_t submissions = 0;
        static inline bool is_on = false; ///< one thread at a time

        command_watch()
        {
            recorded.clear();
            submitted.clear();
            is_on = true;
        }
        ~command_watch() { is_on = false; }
        command_watch(const command_watch&) = delete;
        command_watch& operator=(const command_watch&) = delete;

        static void record(const command& c)
        {
            if (is_on)
                recorded[c.in].push_back(c);
        }
        static void submit(VkCommandBuffer commands)
        {
            ++submissions; // batches use command buffers again
            if (is_on)
                for (auto c : recorded[commands]) {
                    c.submission = submissions;
                    submitted.push_back(c);
                }
        }

        /// Changes between our work and the caller's, whose command buffers are `callers`: how many there are, and how
        /// many of these have no barrier between them.
        static std::pair<int, int> turns(const std::set<VkCommandBuffer>& callers)
        {
            int all = 0, open = 0;
            bool connected = false;
            const command* last = nullptr;
            for (const auto& c : submitted) {
                connected = connected || c.connects_all();
                if (c.is_barrier)
                    continue;
                if (last && callers.contains(last->in) != callers.contains(c.in)) {
                    ++all;
                    open += connected ? 0 : 1;
                }
                last = &c;
                connected = false;
            }
            return {all, open};
        }
    };

    [[noreturn]] void no_library(const char* function)
    {
        std::fprintf(stderr, "%s: libvulkan has none after this program's own\n", function);
        std::abort();
    }

} // namespace

TEST_F(callers_device, takes_turns_with_commands_of_any_kind)
{
    constexpr uint n = 1000;
    application::own_buffer ids, result;
    app.make(ids, n * sizeof(uint), vulkan_backend::adopted_usage);
    app.make(result, n * sizeof(uint), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    vulkan_backend b(app.handles);
    const auto from = b.upload(std::span<const uvec2>(random_pairs(n)));
    auto adopted = b.adopt<uint>(ids.buffer, n);
    std::set<VkCommandBuffer> callers;
    const command_watch watch;
    // A pass that waits in a batch; passes that fill batches, so that nothing waits; and again one.
    for (const uint passes : {1u, photongrid::vulkan::passes_per_batch, 1u}) {
        for (uint p = 0; p < passes; ++p)
            b.run<kernels::pair_value>(n, {}, reads(from), writes(adopted));
        (void)b.handle(adopted);
        const auto copy = app.record_copy(ids.buffer, result.buffer, n * sizeof(uint));
        callers.insert(copy);
        app.submit(copy);
    }
    app.wait();
    b.finish();
    const auto [turns, open] = command_watch::turns(callers);
    EXPECT_EQ(turns, 5); // ours, theirs, ours, theirs, ours, theirs
    EXPECT_EQ(open, 0);
}

TEST_F(callers_device, shows_the_host_what_a_batch_wrote)
{
    constexpr uint n = 100;
    vulkan_backend b(app.handles);
    const auto pairs = random_pairs(n);
    const auto from = b.upload(std::span<const uvec2>(pairs));
    auto to = b.make<uint>(n);
    const command_watch watch;
    for (uint p = 0; p < photongrid::vulkan::passes_per_batch + 1; ++p)
        b.run<kernels::pair_value>(n, {}, reads(from), writes(to));
    (void)b.download(to);
    std::map<std::size_t, bool> shown; // of each submission, at its end
    for (const auto& c : command_watch::submitted)
        if (!c.is_barrier || c.shows_the_host())
            shown[c.submission] = c.is_barrier;
    EXPECT_GE(shown.size(), 2u);
    for (const auto& [batch, at_its_end] : shown)
        EXPECT_TRUE(at_its_end);
}

} // namespace photongrid::testing

// The linker takes these for photongrid's calls and the tests', before those of libvulkan, which they call.
extern "C" {

#define NEXT(F)                                                                                                        \
    static const auto next = reinterpret_cast<PFN_##F>(dlsym(RTLD_NEXT, #F));                                          \
    if (next == nullptr)                                                                                               \
    photongrid::testing::no_library(#F)

VKAPI_ATTR VkResult VKAPI_CALL vkBeginCommandBuffer(VkCommandBuffer commands, const VkCommandBufferBeginInfo* info)
{
    NEXT(vkBeginCommandBuffer);
    if (photongrid::testing::command_watch::is_on)
        photongrid::testing::command_watch::recorded[commands].clear();
    return next(commands, info);
}
VKAPI_ATTR void VKAPI_CALL vkCmdDispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z)
{
    NEXT(vkCmdDispatch);
    photongrid::testing::command_watch::record({.in = commands});
    next(commands, x, y, z);
}
VKAPI_ATTR void VKAPI_CALL vkCmdDispatchIndirect(VkCommandBuffer commands, VkBuffer buffer, VkDeviceSize offset)
{
    NEXT(vkCmdDispatchIndirect);
    photongrid::testing::command_watch::record({.in = commands});
    next(commands, buffer, offset);
}
VKAPI_ATTR void VKAPI_CALL vkCmdCopyBuffer(
    VkCommandBuffer commands, VkBuffer from, VkBuffer to, uint32_t count, const VkBufferCopy* regions)
{
    NEXT(vkCmdCopyBuffer);
    photongrid::testing::command_watch::record({.in = commands});
    next(commands, from, to, count, regions);
}
VKAPI_ATTR void VKAPI_CALL vkCmdFillBuffer(
    VkCommandBuffer commands, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, uint32_t data)
{
    NEXT(vkCmdFillBuffer);
    photongrid::testing::command_watch::record({.in = commands});
    next(commands, buffer, offset, size, data);
}
VKAPI_ATTR void VKAPI_CALL vkCmdPipelineBarrier(VkCommandBuffer commands, VkPipelineStageFlags from,
    VkPipelineStageFlags to, VkDependencyFlags flags, uint32_t barriers, const VkMemoryBarrier* barrier,
    uint32_t of_buffers, const VkBufferMemoryBarrier* buffer, uint32_t of_images, const VkImageMemoryBarrier* image)
{
    NEXT(vkCmdPipelineBarrier);
    for (uint32_t i = 0; i < barriers; ++i)
        photongrid::testing::command_watch::record(
            {commands, true, from, to, barrier[i].srcAccessMask, barrier[i].dstAccessMask});
    next(commands, from, to, flags, barriers, barrier, of_buffers, buffer, of_images, image);
}
VKAPI_ATTR VkResult VKAPI_CALL vkQueueSubmit(
    VkQueue queue, uint32_t count, const VkSubmitInfo* submissions, VkFence fence)
{
    NEXT(vkQueueSubmit);
    for (uint32_t s = 0; s < count; ++s)
        for (uint32_t c = 0; c < submissions[s].commandBufferCount; ++c)
            photongrid::testing::command_watch::submit(submissions[s].pCommandBuffers[c]);
    return next(queue, count, submissions, fence);
}

#undef NEXT
}
