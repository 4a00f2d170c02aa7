// count, route, and what a backend reports about itself.
#pragma once

#include "verbs.hpp"

namespace photongrid::testing {

TYPED_TEST_P(verbs, a_count_is_of_its_elements_and_exact)
{
    auto& b = this->b();
    const uint n = 9000;
    const auto words = this->random_words(n, 6);
    const auto random = this->up(words), all = this->up(std::vector<uint>(n, 1u));
    for (const uint first : {0u, 1u, 63u, 2048u, 3001u})
        for (const uint elements : {0u, 1u, 2u, 64u, 65u, 2048u, 5999u}) {
            const auto count = [&](const auto& buffer, uint marks) {
                return b.template count<verb_kernels::is_marked>({elements, first}, {.marks = marks}, reads(buffer));
            };
            const auto begin = words.begin() + first, end = begin + elements;
            EXPECT_EQ(count(all, 1), elements) << elements << " from " << first;
            EXPECT_EQ(count(all, 2), 0u) << elements << " from " << first;
            EXPECT_EQ(count(random, 8),
                static_cast<std::uint64_t>(std::count_if(begin, end, [](uint x) { return (x & 8u) != 0; })))
                << elements << " from " << first;
            if (elements == 0)
                continue;
            // The first and the last element, and the ones before and after these.
            std::vector<uint> ends(n + 1, 0u);
            ends[first] |= 1;
            ends[first + elements - 1] |= 2;
            ends[first > 0 ? first - 1 : n] |= 4;
            ends[first + elements] |= 4;
            const auto ends_ = this->up(ends);
            EXPECT_EQ(count(ends_, 1), 1u) << elements << " from " << first;
            EXPECT_EQ(count(ends_, 2), 1u) << elements << " from " << first;
            EXPECT_EQ(count(ends_, 4), 0u) << elements << " from " << first;
        }
}

// --- route
// ------------------------------------------------------------------------------------------------------------

TYPED_TEST_P(verbs, a_route_keeps_the_first_draws_and_adds_up_all)
{
    auto& b = this->b();
    for (const uint draws : {0u, 1u, 17u, 6000u})
        for (const uint destinations : {1u, 7u, 1000u})
            for (const uint m : {1u, 2u, b.caps().max_route_slots})
                for (const uint parts : {1u, 3u})
                    for (const uint first : {0u, 2045u}) {
                        if (destinations == 1000 && parts == 3 && m > 2)
                            continue; // as the others, and large
                        const uint n = first + draws, capacity = route_capacity(m);
                        random_source random(n + destinations + m);
                        std::vector<uint> sent(n);
                        std::vector<glm::vec4> amounts(n);
                        for (uint i = 0; i < n; ++i) {
                            sent[i] = random.below(8) == 0
                                ? no_id - random.below(2)
                                : random.below(destinations + destinations / 10 + 1); // some to none
                            amounts[i] = {random(), -random(), 1e-3f * random(), 1};
                        }
                        const uint spare = destinations > 3 ? 3 : 0; // larger than needed: emptied too
                        std::vector<uint> slots((destinations + spare) * capacity, no_id), arrived(destinations);
                        std::vector<glm::vec4> totals(destinations * parts + spare, glm::vec4(0));
                        const uint block = std::max(1u, (draws + parts - 1) / parts);
                        for (uint i = first; i < n; ++i) {
                            const uint d = sent[i];
                            if (d >= destinations)
                                continue;
                            if (arrived[d] < capacity)
                                slots[d * capacity + arrived[d]++] = 5 + 3 * i;
                            totals[d * parts + (i - first) / block] += amounts[i];
                        }
                        auto slots_ = this->up(std::vector<uint>(slots.size(), 5u));
                        auto totals_ = this->up(std::vector<glm::vec4>(totals.size(), glm::vec4(5)));
                        b.template route<verb_kernels::delivery>({draws, first}, {.first_payload = 5},
                            reads(this->up(sent), this->up(amounts)), {destinations, m}, slots_, totals_);
                        const auto where = ::testing::Message()
                            << draws << " draws from " << first << " to " << destinations << " destinations, m " << m
                            << ", " << parts << " parts";
                        EXPECT_EQ(count_different_bits(b.download(slots_), slots), 0u) << where;
                        EXPECT_EQ(count_different_bits(b.download(totals_), totals), 0u) << where;
                    }
}

// --- reports
// -------------------------------------------------------------------------------------------

TYPED_TEST_P(verbs, passes_are_counted_by_kernel)
{
    auto& b = this->b();
    const uint n = 100;
    const auto passes = [&](const char* kernel) {
        const auto found = b.costs().find(kernel);
        return found == b.costs().end() ? 0 : found->second.passes;
    };
    const std::array names{"shifted", "countdown", "is_marked", "delivery"};
    std::array<std::uint64_t, 4> before{};
    std::transform(names.begin(), names.end(), before.begin(), passes);
    const auto in = this->up(std::vector<uint>(n, 1u));
    const auto amounts = this->up(std::vector<glm::vec4>(n));
    auto out = b.template make<uint>(n);
    auto totals = b.template make<glm::vec4>(n);
    auto state = this->up(std::vector<glm::uvec2>(n, glm::uvec2(9, 0)));
    for (int pass = 0; pass < 3; ++pass)
        b.template run<verb_kernels::shifted>(n, {.added = 1}, reads(in), writes(out));
    for (const uint most : {4u, 10u})
        b.template run_until_done<verb_kernels::countdown>(n, {.step = 1}, reads(in), writes(state, out), most);
    for (int again = 0; again < 2; ++again)
        b.template count<verb_kernels::is_marked>(n, {.marks = 1}, reads(in));
    b.template route<verb_kernels::delivery>(n, {.first_payload = 0}, reads(in, amounts), {10, 1}, out, totals);
    b.finish();
    const std::array<std::uint64_t, 4> expected{3, 9, 2, 1};
    for (std::size_t k = 0; k < names.size(); ++k)
        EXPECT_EQ(passes(names[k]) - before[k], expected[k]) << names[k];
}

TYPED_TEST_P(verbs, finish_may_be_called_at_any_time)
{
    auto& b = this->b();
    const uint n = 5000;
    const auto in = this->random_words(n, 7);
    const auto in_ = this->up(in);
    b.finish();
    b.finish();
    auto out = b.template make<uint>(n);
    b.template run<verb_kernels::shifted>(n, {.added = 0}, reads(in_), writes(out));
    b.finish();
    b.finish();
    std::vector<uint> expected(n);
    for (uint i = 0; i < n; ++i)
        expected[i] = in[i] + i;
    EXPECT_EQ(b.download(out), expected);
    b.finish();
    EXPECT_EQ(b.download(out), expected); // reading changes nothing
}

TYPED_TEST_P(verbs, capabilities_can_be_worked_with)
{
    const auto& c = this->b().caps();
    EXPECT_FALSE(c.backend.empty());
    EXPECT_FALSE(c.device.empty());
    EXPECT_GE(c.max_elements, 1u << 20);
    EXPECT_LE(c.max_elements, 0xFFFFFFFFu); // elements are numbered by 32 bits
    EXPECT_GE(c.max_route_slots, 1u);
    EXPECT_LE(c.max_route_slots, 16u);
    EXPECT_GT(c.cells_per_radius, 0.0f);
    EXPECT_EQ(&c, &this->b().caps());
}

} // namespace photongrid::testing
