// Indirect passes: each pass writes how many workgroups the next one has, so the host submits several without waiting.
#pragma once

#include <photongrid/backends/vulkan/passes.hpp>

namespace photongrid::vulkan {

/// Eight words per pass: the workgroups of its dispatch, the length of its list, the number of elements that are not
/// done, and counts of workgroups (iterate.glsl).
struct pass_slot {
    glm::uvec4 dispatch;
    glm::uvec4 unfinished;
};

/// Passes over frames, as vulkan_backend::run_frames describes them. `buffers`: those of the kernel.
template <class K>
progress run_frames(passes& on, const launch& l, uint stride, const typename K::Params& args,
    std::vector<memory> buffers, uint max_passes)
{
    progress p;
    constexpr uint most_together = 8; // passes per reading of the slots by the host
    constexpr VkDeviceSize slot_bytes = sizeof(pass_slot);
    const auto control = on.allocate((most_together + 1) * slot_bytes);
    const auto list_bytes = on.made.groups(l.elements) * on.made.group() * sizeof(uint);
    std::array<memory, 2> lists{on.allocate(list_bytes), on.allocate(list_bytes)};
    const auto first_extra = buffers.size();
    buffers.insert(buffers.end(), {lists[1], lists[0], control});
    on.batches.fill(control, 0, control->bytes(), 0);
    on.run<K>(verb::list, l, l.first, args, buffers);
    const auto& iterate = on.made.get<K>(verb::iterate, l.switches, buffers);
    // As many passes as the last run of the kernel took, since passes over nothing take time too.
    uint& usual = on.usual_passes(std::string(kernel_name<K>()));
    uint together = usual;
    for (;;) {
        const uint now = std::min(together, max_passes - p.passes);
        for (uint q = 0; q < now; ++q) {
            buffers[first_extra] = lists[0];
            buffers[first_extra + 1] = lists[1];
            on.batches.dispatch_indirect(iterate, buffers, on.push(l, q, (p.passes + q) * stride, args), control,
                q * slot_bytes, on.made.cost<K>().ms);
            std::swap(lists[0], lists[1]);
        }
        std::array<pass_slot, most_together + 1> seen{};
        on.batches.read(control, seen.data(), sizeof seen);
        for (uint q = 0; q < now && seen[q].unfinished.x > 0; ++q) {
            p.active.push_back(seen[q].unfinished.x);
            ++p.passes;
        }
        p.finished = seen[now].unfinished.x == 0;
        if (p.finished || p.passes == max_passes)
            break;
        // The next pass continues where the last one ended.
        on.batches.copy(control, now * slot_bytes, control, 0, slot_bytes);
        on.batches.fill(control, slot_bytes, most_together * slot_bytes, 0);
        together = most_together;
    }
    usual = std::clamp(p.passes, 1u, most_together);
    on.made.cost<K>().passes += p.passes;
    return p;
}

} // namespace photongrid::vulkan
