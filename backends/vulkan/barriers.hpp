// Barriers between the commands on a queue.
#pragma once

#include <photongrid/backends/vulkan/errors.hpp>

namespace photongrid::vulkan {

/// Later commands of these stages see what our passes and transfers have written.
inline void barrier(VkCommandBuffer commands, VkPipelineStageFlags stages, VkAccessFlags reads)
{
    VkMemoryBarrier b{};
    b.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    b.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    b.dstAccessMask = reads;
    vkCmdPipelineBarrier(commands,
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
        stages, 0, 1, &b, 0, nullptr, 0, nullptr);
}

/// A barrier between our commands and the caller's on the queue.
inline void full_barrier(VkCommandBuffer commands)
{
    VkMemoryBarrier b{};
    b.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    b.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    b.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &b, 0,
        nullptr, 0, nullptr);
}

} // namespace photongrid::vulkan
