// Sorts and indexes of any size on any backend.
#pragma once

#include "algorithms.hpp"

namespace photongrid::testing {

TYPED_TEST_P(algorithms, sort_equals_std_sort_for_any_size_and_keys)
{
    EXPECT_TRUE(rc::check("sorted, every value kept, ties in order of value", [&] {
        const auto keys = *any_keys(*rc::gen::element(1u, 2u, 5u, 1000u, 0xFFFFFFFFu), 3000);
        std::vector<uvec2> pairs;
        for (const uint key : keys)
            pairs.emplace_back(key, static_cast<uint>(pairs.size()));
        RC_ASSERT(this->sorted_on_device(pairs) == this->sorted_by_std(pairs));
    }));
}

TYPED_TEST_P(algorithms, sort_handles_the_sizes_where_networks_break)
{
    for (const std::size_t n : {0u, 1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 1023u, 1024u, 1025u, 65535u, 65536u, 65537u}) {
        random_source u(n);
        std::vector<uvec2> pairs;
        for (std::size_t i = 0; i < n; ++i)
            pairs.emplace_back(u.below(100), 0xFFFFFFFFu - u.below(50)); // repeated pairs, the largest value among them
        EXPECT_EQ(this->sorted_on_device(pairs), this->sorted_by_std(pairs)) << n << " pairs";
    }
}

TYPED_TEST_P(algorithms, the_generic_sort_is_right_where_an_override_replaces_it)
{
    auto& b = this->b();
    using B = std::remove_reference_t<decltype(b)>;
    for (const std::size_t n : {2u, 15u, 16u, 1000u, 4096u}) {
        random_source u(n);
        std::vector<uvec2> pairs;
        for (std::size_t i = 0; i < n; ++i)
            pairs.emplace_back(u.below(50), u.below(50));
        auto buffer = b.upload(std::span<const uvec2>(pairs));
        const auto report = bitonic_sort<B>(b, buffer);
        EXPECT_EQ(report.passes, report.steps);
        EXPECT_EQ(b.download(buffer), this->sorted_by_std(pairs)) << n << " pairs";
    }
}

TYPED_TEST_P(algorithms, sort_reports_the_papers_numbers_of_passes)
{
    sort_report report;
    this->sorted_on_device(std::vector<uvec2>(65536), &report);
    EXPECT_EQ(report.steps, 136u);
    if (sorts_by_network<TypeParam>()) {
        EXPECT_EQ(report.passes, 136u);
    } else {
        EXPECT_LT(report.passes, 136u);
    }
    this->sorted_on_device(std::vector<uvec2>(65000), &report);
    EXPECT_EQ(report.steps, 136u);
    this->sorted_on_device(std::vector<uvec2>(1), &report);
    EXPECT_EQ(report.steps, 0u);
}

TYPED_TEST_P(algorithms, long_a_million_pairs_sort_and_index)
{
    const std::size_t n = 1048576;
    random_source u(1);
    std::vector<uvec2> pairs;
    for (std::size_t i = 0; i < n; ++i)
        pairs.emplace_back(u.below(31250), static_cast<uint>(i));
    auto buffer = this->b().upload(std::span<const uvec2>(pairs));
    EXPECT_EQ(bitonic_sort(this->b(), buffer).steps, 210u); // the paper's figure
    EXPECT_EQ(this->b().download(buffer), this->sorted_by_std(pairs));
    const auto cells = this->b().download(grid_index(this->b(), buffer, 31250));
    std::uint64_t sum = 0;
    for (const auto& c : cells)
        sum += c.y;
    EXPECT_EQ(sum, n);
}

// --- grid_index
// -------------------------------------------------------------------------------------------------------

TYPED_TEST_P(algorithms, index_equals_the_histogram)
{
    EXPECT_TRUE(rc::check("first = number of smaller keys, count = histogram", [&] {
        const auto cells = *rc::gen::inRange<uint>(1, 500);
        auto keys = *any_keys(cells, 2000);
        for (auto& k : keys) // often in the first or in the last cell
            k = k % 8 == 3 ? 0u : k % 8 == 5 ? cells - 1 : k;
        std::sort(keys.begin(), keys.end());
        std::vector<uvec2> pairs;
        for (const auto k : keys)
            pairs.emplace_back(k, 7u);
        const auto index
            = this->b().download(grid_index(this->b(), this->b().upload(std::span<const uvec2>(pairs)), cells));
        RC_ASSERT(index.size() == cells);
        for (uint c = 0; c < cells; ++c) {
            RC_ASSERT(index[c].x == static_cast<uint>(std::lower_bound(keys.begin(), keys.end(), c) - keys.begin()));
            RC_ASSERT(index[c].y == static_cast<uint>(std::count(keys.begin(), keys.end(), c)));
        }
    }));
}

// --- stencil_route
// ----------------------------------------------------------------------------------------------------

} // namespace photongrid::testing
