// Routing: draws are sorted stably by destination, so that ranks follow the draw order and amounts are added in that
// order.
#pragma once

#include <photongrid/backends/vulkan/passes.hpp>

namespace photongrid::vulkan {

/// Memory that is no longer counted when this object is destroyed, although passes may still use it.
struct scratch {
    memory held;
    explicit scratch(memory m) : held(std::move(m)) {}
    scratch(const scratch&) = delete;
    scratch& operator=(const scratch&) = delete;
    ~scratch() { held->forget(); }
};

/// A routing of `draws` draws. It needs 40 bytes per draw and 8 per destination.
class routing {
public:
    routing(passes& on, uint draws, uint destinations)
        : on_(on), draws_(draws), destinations_(destinations), destination_(on.make<uint>(draws)),
          payload_(on.make<uint>(draws)), amount_(on.make<glm::vec4>(draws))
    {
    }

    /// The outputs of the route kernel, which writes draw i as element i.
    std::array<memory, 3> outputs() const { return {destination_.held, payload_.held, amount_.held}; }

    /// To be called when the kernel has run. Computes the slots, and then the totals, of so many elements.
    void deliver(const memory& slots, std::size_t slot_count, uint m, const memory& totals, std::size_t total_count)
    {
        scratch keys(on_.make<glm::uvec2>(draws_));
        on_.own("route_keys", draws_, {destinations_}, {destination_.held, keys.held});
        sort(keys);

        const scratch ranges(on_.make<glm::uvec2>(destinations_));
        const auto most = on_.allocate(sizeof(uint));
        on_.batches.fill(most, 0, sizeof(uint), 0);
        on_.own("route_ranges", destinations_, {draws_}, {keys.held, ranges.held, most});
        on_.own("route_slots", slot_count, {destinations_, route_capacity(m)},
            {keys.held, ranges.held, payload_.held, slots});
        uint longest = 0;
        on_.batches.read(most, &longest, sizeof longest);
        constexpr uint at_once = 4096;
        const uint sums = route_sums(total_count, destinations_), block = route_block(draws_, sums);
        std::uint64_t begin = 0;
        do { // at least once: it also clears the totals of destinations without draws
            on_.own("route_totals", total_count, {destinations_, sums, block, static_cast<uint>(begin), at_once},
                {keys.held, ranges.held, amount_.held, totals});
            begin += at_once;
        } while (begin < std::min(longest, block));
    }

private:
    /// Sorts (destination, draw) stably by destination: least significant digit first, 4 bits at a time.
    void sort(scratch& keys)
    {
        const uint n = draws_;
        if (n < 2)
            return;
        // One invocation processes a chunk in order. More than 16,384 chunks would make the prefix sums of counters
        // slow.
        const uint chunk = std::max(256u, (n - 1) / 16384u + 1);
        const uint chunks = (n - 1) / chunk + 1;
        scratch sorted(on_.make<glm::uvec2>(n));
        const scratch counters(on_.make<uint>(std::size_t{16} * chunks));
        for (uint shift = 0; shift < 32 && (destinations_ >> shift) != 0; shift += 4) {
            on_.own("radix_count", chunks, {n, shift, chunk, chunks}, {keys.held, counters.held});
            on_.own("radix_scan", 1, {16 * chunks}, {counters.held});
            on_.own("radix_scatter", chunks, {n, shift, chunk, chunks}, {keys.held, counters.held, sorted.held});
            std::swap(keys.held, sorted.held);
        }
    }

    passes& on_;
    uint draws_, destinations_;
    scratch destination_, payload_, amount_;
};

} // namespace photongrid::vulkan
