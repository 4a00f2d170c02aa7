// What the four algorithms promise, on any backend. References: std::, brute force, FLANN; then the serial backend, bit
// for bit. Included by each on_<backend>.cpp, which instantiates the suite for its tags.
#pragma once

#include "known_answers.hpp"
#include "photon_sets.hpp"
#include "serial_algorithms.hpp"
#include "under_test.hpp"

#include <photongrid/build_map.hpp>
#include <photongrid/fitting_grid.hpp>
#include <photongrid/knn_grid_estimate.hpp>
#include <photongrid/self_test.hpp>

#include <rapidcheck.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace photongrid::testing {

using glm::uvec2;
using glm::uvec3;
using glm::vec4;

template <class Tag>
class algorithms : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    std::vector<uvec2> sorted_on_device(std::vector<uvec2> pairs, sort_report* report = nullptr)
    {
        auto buffer = this->b().upload(std::span<const uvec2>(pairs));
        const auto r = bitonic_sort(this->b(), buffer);
        if (report != nullptr)
            *report = r;
        return this->b().download(buffer);
    }

    static std::vector<uvec2> sorted_by_std(std::vector<uvec2> pairs)
    {
        std::sort(pairs.begin(), pairs.end(), [](uvec2 a, uvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
        return pairs;
    }
};
TYPED_TEST_SUITE_P(algorithms);

// --- buffers
// ----------------------------------------------------------------------------------------------------------

TYPED_TEST_P(algorithms, buffers_keep_every_bit)
{
    auto& b = this->b();
    for (const std::size_t n : {0u, 1u, 2u, 63u, 64u, 2047u, 2048u, 2049u, 70000u}) {
        random_source u(n);
        const auto check = [&](auto make) {
            std::vector<decltype(make())> host(n);
            for (auto& x : host)
                x = make();
            const auto device = b.upload(std::span<const decltype(make())>(host));
            ASSERT_EQ(device.size(), n);
            EXPECT_EQ(count_different_bits(b.download(device), host), 0u);
        };
        const auto integer = [&] { return u.below(0xFFFFFFFFu); };
        check([&] { return integer(); });
        check([&] { return uvec2(integer(), integer()); });
        check([&] { return glm::uvec4(integer(), integer(), integer(), integer()); });
        check([&] { return u() * 1e6f; });
        check([&] { return glm::vec2(u(), -u()); });
        check([&] { return vec4(u(), -u(), u() * 1e30f, u() * 1e-30f); });
    }
}

TYPED_TEST_P(algorithms, a_pass_outside_a_buffer_is_refused)
{
    auto& b = this->b();
    auto in = b.template make<uint>(10);
    auto small = b.template make<uint>(9);
    auto pairs = b.template make<uvec2>(10);
    EXPECT_THROW(b.template run<kernels::pair_value>(10, {}, reads(pairs), writes(small)), std::invalid_argument);
    EXPECT_THROW(b.template run<kernels::pair_value>({10, 1}, {}, reads(pairs), writes(in)), std::invalid_argument);
    EXPECT_NO_THROW(b.template run<kernels::pair_value>({9, 1}, {}, reads(pairs), writes(in)));
}

TYPED_TEST_P(algorithms, memory_is_accounted_for)
{
    auto& b = this->b();
    const auto before = b.bytes();
    {
        const auto buffer = b.template make<vec4>(100000);
        EXPECT_GE(b.bytes(), before + 1600000u);
        EXPECT_GE(b.peak_bytes(), b.bytes());
    }
    b.finish();
    EXPECT_EQ(b.bytes(), before);
}

TYPED_TEST_P(algorithms, the_self_test_of_arithmetic_agrees_with_the_capabilities)
{
    const auto [division, square_root] = test_arithmetic(this->b());
    EXPECT_EQ(division, this->b().caps().exact_division);
    EXPECT_EQ(square_root, this->b().caps().exact_sqrt);
}

TYPED_TEST_P(algorithms, no_photon_lies_beyond_the_last_of_more_cells_than_floats_count)
{
    auto& b = this->b();
    const uint cells = (1u << 24) + 4;
    const std::vector<vec4> positions{{0, 0, 0, 0}, {1, 0, 0, 0}, {1e30f, 0, 0, 0}, {0.5f, 0, 0, 0}},
        powers(4, vec4(1));
    auto pairs = b.template make<uvec2>(4);
    b.template run<kernels::photon_cell>(4,
        {.grid = make_grid(glm::vec3(0), glm::vec3(1), {cells, 1, 1}), .photons = 4, .parts = every_part},
        reads(b.upload(std::span<const vec4>(positions)), b.upload(std::span<const vec4>(powers))), writes(pairs));
    EXPECT_EQ(b.download(pairs), (std::vector<uvec2>{{0, 0}, {cells - 1, 1}, {cells - 1, 2}, {cells / 2, 3}}));
}

// --- bitonic_sort
// -----------------------------------------------------------------------------------------------------

TYPED_TEST_P(algorithms, sort_equals_std_sort_for_any_size_and_keys)
{
    EXPECT_TRUE(rc::check("sorted, every value kept, ties in order of value", [&] {
        const auto n = *rc::gen::inRange<std::size_t>(0, 3000);
        const auto distinct = *rc::gen::element(1u, 2u, 5u, 1000u, 0xFFFFFFFFu);
        const auto seed = *rc::gen::arbitrary<std::uint64_t>();
        random_source u(seed);
        std::vector<uvec2> pairs;
        for (std::size_t i = 0; i < n; ++i)
            pairs.emplace_back(u.below(8) == 0 ? 0xFFFFFFFFu : u.below(distinct), static_cast<uint>(i));
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

TYPED_TEST_P(algorithms, the_generic_sort_is_right_where_another_stands_for_it)
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
        const auto n = *rc::gen::inRange<std::size_t>(0, 2000);
        const auto cells = *rc::gen::inRange<uint>(1, 500);
        const auto kind = *rc::gen::element(0, 1, 2, 3);
        random_source u(*rc::gen::arbitrary<std::uint64_t>());
        std::vector<uint> keys(n);
        for (auto& k : keys)
            k = kind == 0   ? u.below(cells)
                : kind == 1 ? 0u
                : kind == 2 ? cells - 1
                            : (u.below(2) != 0u ? 0xFFFFFFFFu : u.below(cells));
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

TEST(permutation, is_one_for_every_size_and_seed)
{
    for (const uint n : {1u, 2u, 3u, 5u, 64u, 1000u, 4097u})
        for (const uint seed : {0u, 1u, 0xDEADBEEFu}) {
            std::vector<bool> seen(n);
            for (uint i = 0; i < n; ++i) {
                const uint p = kernels::permuted(i, n, seed);
                ASSERT_LT(p, n);
                ASSERT_FALSE(seen[p]);
                seen[p] = true;
            }
        }
}

TYPED_TEST_P(algorithms, route_keeps_the_first_in_draw_order_and_all_the_flux)
{
    auto& b = this->b();
    double largest = 0;
    for (const uint m : {1u, 2u, 3u, 4u, 8u, 15u, 16u})
        for (const auto d :
            {distribution::uniform, distribution::clustered, distribution::coincident, distribution::cell_faces}) {
            const uint n = 3000;
            const uint seed = 17 * m;
            const auto set = make_photons(d, n, {6, 5, 4}, m);
            const auto routed = stencil_route(b, upload_photons(b, set), set.g, m, seed);
            const auto cells = b.download(routed.cells);
            const auto list = b.download(routed.list);
            const auto totals = b.download(routed.totals);
            const auto powers = b.download(routed.powers);

            // The reference: walk the draws, keep the first.
            std::vector<std::vector<uint>> destined(cells.size());
            for (uint i = 0; i < n; ++i) {
                const uint id = kernels::permuted(i, n, seed);
                const glm::vec3 cell = glm::clamp(glm::floor((glm::vec3(set.positions[id]) - glm::vec3(set.g.origin))
                                                      * glm::vec3(set.g.inverse_cell)),
                    glm::vec3(0), glm::vec3(5, 4, 3));
                destined[static_cast<std::size_t>((cell.z * 5 + cell.y) * 6 + cell.x)].push_back(id);
            }
            const uint capacity = std::min(m * m, 255u);
            std::uint64_t overfull = 0;
            for (std::size_t c = 0; c < cells.size(); ++c) {
                const uint kept = std::min<uint>(capacity, static_cast<uint>(destined[c].size()));
                overfull += destined[c].size() > capacity ? 1u : 0u;
                ASSERT_EQ(cells[c], uvec2(c * capacity, kept)) << "cell " << c << " m " << m << " " << name_of(d);
                ASSERT_EQ(totals[c].w, static_cast<float>(destined[c].size()));
                glm::dvec3 before(0), after(0);
                for (uint s = 0; s < capacity; ++s) {
                    ASSERT_EQ(list[c * capacity + s], s < kept ? destined[c][s] : nowhere)
                        << "cell " << c << " slot " << s << " m " << m << " " << name_of(d);
                    if (s < kept)
                        after += glm::dvec3(powers[destined[c][s]]);
                }
                for (const uint id : destined[c])
                    before += glm::dvec3(set.powers[id]);
                for (int channel = 0; channel < 3; ++channel) {
                    ASSERT_NEAR(after[channel], before[channel], 1e-5 * before[channel])
                        << "cell " << c << " m " << m << " " << name_of(d);
                    if (before[channel] > 0)
                        largest = std::max(largest, std::abs(after[channel] / before[channel] - 1));
                }
            }
            EXPECT_EQ(routed.overfull_cells, overfull);
        }
    this->report("A1", "relative error of a cell's flux:", largest);
}

TYPED_TEST_P(algorithms, route_conserves_unequal_powers_and_absent_channels)
{
    // 300 photons in one cell of 16: powers over 12 decades, and green carried by photons that are not kept.
    auto& b = this->b();
    const uint n = 300;
    photon_set set;
    set.g = make_grid(glm::vec3(0), glm::vec3(1), {1, 1, 1});
    random_source u(3);
    for (uint i = 0; i < n; ++i) {
        set.positions.emplace_back(u(), u(), u(), 0.0f);
        set.powers.emplace_back(std::pow(10.0f, 12 * u() - 6), 0.0f, 1.0f, 0.0f);
    }
    for (uint i = 16; i < n; ++i)
        set.powers[kernels::permuted(i, n, 5)].y = 2.0f;
    const auto routed = stencil_route(b, upload_photons(b, set), set.g, 4, 5);
    const auto list = b.download(routed.list);
    const auto powers = b.download(routed.powers);
    glm::dvec3 before(0), after(0);
    for (const auto& p : set.powers)
        before += glm::dvec3(p);
    for (const uint id : list) {
        after += glm::dvec3(powers[id]);
        EXPECT_FLOAT_EQ(powers[id].y, 2.0f * (n - 16) / 16); // spread evenly
    }
    double largest = 0;
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(after[channel], before[channel], 1e-5 * before[channel]);
        largest = std::max(largest, std::abs(after[channel] / before[channel] - 1));
    }
    this->report("A3", "relative error of flux over 12 decades:", largest);
}

TYPED_TEST_P(algorithms, route_takes_a_hundred_thousand_photons_to_one_cell)
{
    auto& b = this->b();
    double largest = 0;
    for (const uint m : {4u, 16u}) {
        const uint n = 100000;
        photon_set set;
        set.g = make_grid(glm::vec3(0), glm::vec3(1), {3, 3, 3});
        set.positions.assign(n, vec4(0.5f, 0.5f, 0.5f, 0.0f));
        set.powers.assign(n, vec4(0x1p-20f, 0x1p-19f, 0x1p-18f, 0.0f)); // powers of two add up exactly
        const auto routed = stencil_route(b, upload_photons(b, set), set.g, m, 9);
        const auto list = b.download(routed.list);
        const auto powers = b.download(routed.powers);
        const uint capacity = route_capacity(m);
        glm::dvec3 after(0);
        std::set<uint> kept;
        for (uint s = 0; s < capacity; ++s) {
            const uint id = list[13 * capacity + s];
            ASSERT_EQ(id, kernels::permuted(s, n, 9)) << "slot " << s;
            kept.insert(id);
            after += glm::dvec3(powers[id]);
        }
        EXPECT_EQ(kept.size(), capacity);
        EXPECT_EQ(b.download(routed.totals)[13], vec4(n * 0x1p-20f, n * 0x1p-19f, n * 0x1p-18f, n));
        EXPECT_NEAR(after.x, n * 0x1p-20, n * 0x1p-20 * 1e-6);
        largest = std::max(largest, std::abs(after.x / (n * 0x1p-20) - 1));
    }
    this->report("A2", "relative error of flux, 100,000 photons of a power of two in a cell:", largest);
}

TYPED_TEST_P(algorithms, route_conserves_flux_in_crowded_cells)
{
    // Float sums of a third: 1e-5 up to 2,048 photons a cell, 5e-4 at 70,000.
    auto& b = this->b();
    for (const auto& [n, tolerance] : {std::pair{2048u, 1e-5}, std::pair{70000u, 5e-4}}) {
        photon_set set;
        set.g = make_grid(glm::vec3(0), glm::vec3(1), {2, 2, 2});
        set.positions.assign(n, vec4(0.2f, 0.7f, 0.2f, 0.0f));
        set.powers.assign(n, vec4(1.0f / 3, 0.1f, 1e-4f / 3, 0.0f));
        const auto routed = stencil_route(b, upload_photons(b, set), set.g, 4, 1);
        const auto powers = b.download(routed.powers);
        const auto list = b.download(routed.list);
        const auto cell = b.download(routed.cells).at(2);
        ASSERT_EQ(cell.y, 16u);
        glm::dvec3 after(0);
        for (uint s = cell.x; s < cell.x + cell.y; ++s)
            after += glm::dvec3(powers[list[s]]);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(after[c], n * static_cast<double>(set.powers[0][c]),
                tolerance * n * static_cast<double>(set.powers[0][c]))
                << n << " photons, channel " << c;
        double largest = 0;
        for (int c = 0; c < 3; ++c)
            largest = std::max(largest, std::abs(after[c] / (n * static_cast<double>(set.powers[0][c])) - 1));
        this->report("A2_" + std::to_string(n),
            "relative error of flux, " + std::to_string(n) + " equal photons in a cell:", largest);
    }
}

TYPED_TEST_P(algorithms, route_is_fair_to_later_photons)
{
    // Two lights' photons, the second's ids after the first's, all in one cell: both keep about half the slots.
    auto& b = this->b();
    photon_set set;
    set.g = make_grid(glm::vec3(0), glm::vec3(1), {1, 1, 1});
    set.positions.assign(2000, vec4(0.5f, 0.5f, 0.5f, 0.0f));
    set.powers.assign(2000, vec4(1));
    const auto photons = upload_photons(b, set);
    std::uint64_t late = 0, kept = 0;
    for (uint seed = 0; seed < 20; ++seed)
        for (const uint id : b.download(stencil_route(b, photons, set.g, 16, seed).list)) {
            ++kept;
            late += id >= 1000 ? 1u : 0u;
        }
    EXPECT_EQ(kept, 20u * 255u);
    EXPECT_NEAR(
        static_cast<double>(late), 0.5 * static_cast<double>(kept), 5 * 0.5 * std::sqrt(static_cast<double>(kept)));
    this->report(
        "A4", "the later light's share of the photons kept:", static_cast<double>(late) / static_cast<double>(kept));
}

TYPED_TEST_P(algorithms, a_map_of_one_part_of_the_light_holds_that_part)
{
    auto& b = this->b();
    auto set = make_photons(distribution::uniform, 2000, {5, 4, 3}, 6);
    std::vector<uint> caustic, other;
    for (uint i = 0; i < 2000; ++i) {
        const bool focused = i % 7 == 3;
        set.positions[i].w = focused ? 1.0f : 0.0f;
        (focused ? caustic : other).push_back(i);
    }
    for (const bool routed : {false, true})
        for (const uint parts : {photongrid::caustic_part, photongrid::other_part, photongrid::every_part}) {
            const auto map = routed ? routed_map(b, upload_photons(b, set), set.g, 16, 2, parts)
                                    : sorted_map(b, upload_photons(b, set), set.g, parts);
            const auto list = b.download(map.list);
            std::vector<uint> held;
            for (const auto& c : b.download(map.cells))
                held.insert(held.end(), list.begin() + c.x, list.begin() + c.x + c.y);
            std::sort(held.begin(), held.end());
            std::vector<uint> expected = parts == photongrid::other_part ? other : caustic;
            if (parts == photongrid::every_part)
                expected.insert(expected.end(), other.begin(), other.end());
            std::sort(expected.begin(), expected.end());
            EXPECT_EQ(held, expected) << "parts " << parts << " routed " << routed;
            EXPECT_EQ(map.left_out, 2000 - expected.size()) << "parts " << parts << " routed " << routed;
        }
}

TYPED_TEST_P(algorithms, route_says_no_to_what_it_cannot_do)
{
    auto& b = this->b();
    const auto set = make_photons(distribution::uniform, 10, {2, 2, 2}, 1);
    const auto photons = upload_photons(b, set);
    EXPECT_THROW(stencil_route(b, photons, set.g, 0), std::invalid_argument);
    EXPECT_THROW(stencil_route(b, photons, set.g, 17), std::invalid_argument);
    try {
        stencil_route(b, photons, make_grid(glm::vec3(0), glm::vec3(1), {1000, 1000, 1000}), 16);
        FAIL() << "255,000,000,000 slots were not refused";
    } catch (const backend_error& e) {
        EXPECT_NE(std::string(e.what()).find("1000000000"), std::string::npos) << e.what();
    }
}

// --- knn_grid_estimate
// ------------------------------------------------------------------------------------------------

TYPED_TEST_P(algorithms, estimate_uses_exactly_the_photons_within_its_radius)
{
    auto& b = this->b();
    EXPECT_TRUE(rc::check("set = brute force, at least k, FLANN's k nearest are in it", [&] {
        const auto d = *rc::gen::elementOf(
            std::vector<distribution>(std::begin(all_distributions), std::end(all_distributions)));
        const auto resolution
            = *rc::gen::element(uvec3(1, 1, 1), uvec3(20, 1, 20), uvec3(5, 5, 10), uvec3(1, 1, 40), uvec3(7, 3, 2));
        const auto n = *rc::gen::element(0, 1, 2, 7, 40, 700);
        const auto k = *rc::gen::element(1u, 2u, 8u, 50u, 5000u);
        const auto radius = *rc::gen::element(1e-4f, 0.03f, 0.2f, 0.7f, 10.0f);
        const bool routed = *rc::gen::arbitrary<bool>();
        const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
        const auto set = make_photons(d, static_cast<std::size_t>(n), resolution, seed);
        const auto points = make_points(set, 40, seed);
        const auto map = routed ? routed_map(b, upload_photons(b, set), set.g, 16, 3)
                                : sorted_map(b, upload_photons(b, set), set.g);
        const auto estimates = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)),
            as_paper(knn_settings{.k = k, .max_radius = radius, .visits_per_pass = 64, .ranges_per_pass = 16}));
        const auto irradiance = b.download(estimates.irradiance);
        const auto used = b.download(estimates.used);

        std::vector<uint> ids; // the photons in the map: routing may have dropped some
        const auto list = b.download(map.list);
        for (const auto& c : b.download(map.cells))
            ids.insert(ids.end(), list.begin() + c.x, list.begin() + c.x + c.y);
        if (!routed) {
            RC_ASSERT(ids.size() == static_cast<std::size_t>(n));
        }
        for (std::size_t q = 0; q < points.size(); ++q) {
            uint inside = 0, within_reach = 0;
            for (const uint id : ids) {
                const float d2 = distance2(points[q], set.positions[id]);
                inside += d2 <= irradiance[q].w ? 1u : 0u;
                within_reach += d2 <= radius * radius ? 1u : 0u;
            }
            RC_ASSERT(used[q].x == inside);
            RC_ASSERT(used[q].x >= std::min(k, within_reach));
            RC_ASSERT(used[q].y >= used[q].x);
            RC_ASSERT(irradiance[q].w <= radius * radius);
        }

        // FLANN: the k-th nearest lies inside the radius used, if it lies inside the maximum.
        if (ids.size() >= k) {
            std::vector<vec4> in_map;
            for (const uint id : ids)
                in_map.push_back(set.positions[id]);
            const auto kth = kth_by_flann(in_map, points, k);
            for (std::size_t q = 0; q < points.size(); ++q) {
                RC_ASSERT(kth[q].has_value());
                if (*kth[q] <= radius * radius) {
                    RC_ASSERT(*kth[q] <= irradiance[q].w);
                }
            }
        }
    }));
}

TYPED_TEST_P(algorithms, estimate_adds_up_the_flux_it_says)
{
    auto& b = this->b();
    const auto set = make_photons(distribution::box_faces, 4000, {10, 10, 20}, 4);
    const auto points = make_points(set, 300, 4);
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const auto estimates = knn_grid_estimate(
        b, map, b.upload(std::span<const vec4>(points)), as_paper(knn_settings{.k = 60, .max_radius = 0.3f}));
    const auto irradiance = b.download(estimates.irradiance);
    const auto used = b.download(estimates.used);
    double largest = 0;
    for (std::size_t q = 0; q < points.size(); ++q) {
        glm::dvec3 flux(0);
        for (std::size_t i = 0; i < set.positions.size(); ++i)
            if (distance2(points[q], set.positions[i]) <= irradiance[q].w)
                flux += glm::dvec3(set.powers[i]);
        const double area = M_PI * static_cast<double>(irradiance[q].w);
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(irradiance[q][c], used[q].x == 0 ? 0 : flux[c] / area, 1e-5 * flux[c] / area);
            if (flux[c] > 0)
                largest = std::max(largest, std::abs(static_cast<double>(irradiance[q][c]) * area / flux[c] - 1));
        }
        if (used[q].x < 60) {
            ASSERT_EQ(irradiance[q].w, 0.3f * 0.3f);
        }
    }
    this->report("A7", "relative error of irradiance:", largest);
}

TYPED_TEST_P(algorithms, estimate_defines_what_has_no_neighbours)
{
    auto& b = this->b();
    const auto set = make_photons(distribution::uniform, 100, {4, 4, 4}, 1);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const std::vector<vec4> points = {{0.5f, 0.5f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 0.0f}, {nan, 0.5f, 0.5f, 1.0f},
        {inf, 0.5f, 0.5f, 1.0f}, {1e20f, 0.5f, 0.5f, 1.0f}};
    const auto at = b.upload(std::span<const vec4>(points));
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const auto counts = [&](const photon_map<typename TestFixture::B>& m, knn_settings s) {
        const auto e = knn_grid_estimate(b, m, at, s);
        for (const auto& v : b.download(e.irradiance))
            EXPECT_TRUE(std::isfinite(v.x) && v.x >= 0);
        std::vector<uint> n;
        for (const auto& u : b.download(e.used))
            n.push_back(u.x);
        return n;
    };
    EXPECT_EQ(counts(map, {.k = 1000, .max_radius = 10}), (std::vector<uint>{100, 0, 0, 0, 0})); // k > n: all of them
    EXPECT_THROW(counts(map, {.k = 0, .max_radius = 1}), std::invalid_argument);
    EXPECT_EQ(counts(map, {.k = 5, .max_radius = 0}), (std::vector<uint>{0, 0, 0, 0, 0}));
    EXPECT_EQ(counts(map, {.k = 5, .max_radius = -1}), (std::vector<uint>{0, 0, 0, 0, 0}));
    EXPECT_EQ(counts(map, {.k = 1000, .max_radius = inf})[0], 100u);
    EXPECT_THROW(counts(map, {.k = 5, .max_radius = nan}), std::invalid_argument);
    const auto none = sorted_map(b, upload_photons(b, {{}, {}, set.g}), set.g);
    EXPECT_EQ(counts(none, {.k = 5, .max_radius = 1}), (std::vector<uint>{0, 0, 0, 0, 0}));
}

TYPED_TEST_P(algorithms, coincident_photons_give_a_finite_estimate)
{
    auto& b = this->b();
    photon_set set;
    set.g = make_grid(glm::vec3(0), glm::vec3(1), {4, 4, 4});
    set.positions.assign(32, vec4(0.5f, 0.5f, 0.5f, 0.0f));
    set.powers.assign(32, vec4(1.0f));
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const std::vector<vec4> points(1, vec4(0.5f, 0.5f, 0.5f, 1.0f));
    const auto e = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)),
        as_paper(knn_settings{.k = 32, .max_radius = 1, .min_radius = 0.01f}));
    const double expected = 32 / (M_PI * 1e-4), found = static_cast<double>(b.download(e.irradiance)[0].x);
    EXPECT_NEAR(found, expected, 1e-5 * expected);
    this->report("A8", "relative error of the disc at the floor:", std::abs(found / expected - 1));
    EXPECT_EQ(b.download(e.used)[0], uvec2(32, 32));
}

TYPED_TEST_P(algorithms, poisoned_photons_are_counted_and_harmless)
{
    auto& b = this->b();
    auto set = make_photons(distribution::uniform, 2000, {5, 5, 5}, 8);
    auto poisoned = set;
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()};
    for (int i = 0; i < 30; ++i) {
        poisoned.positions.emplace_back(i % 2 == 0 ? bad[i % 3] : 0.5f, 0.5f, 0.5f, 0.0f);
        poisoned.powers.emplace_back(i % 2 == 0 ? 1.0f : bad[i % 3], 1.0f, 1.0f, 0.0f);
    }
    const auto points = make_points(set, 200, 8);
    const auto at = b.upload(std::span<const vec4>(points));
    std::size_t different = 0;
    for (const bool routed : {false, true}) {
        const auto map = [&](const photon_set& s) {
            return routed ? routed_map(b, upload_photons(b, s), s.g, 16) : sorted_map(b, upload_photons(b, s), s.g);
        };
        const auto clean = map(set), dirty = map(poisoned);
        EXPECT_EQ(clean.invalid, 0u);
        EXPECT_EQ(dirty.invalid, 30u);
        const auto a = knn_grid_estimate(b, clean, at, {.k = 20, .max_radius = 0.5f});
        const auto c = knn_grid_estimate(b, dirty, at, {.k = 20, .max_radius = 0.5f});
        if (!routed) { // routing draws in another order when there are more photons
            different = count_different_bits(b.download(a.irradiance), b.download(c.irradiance));
            EXPECT_EQ(different, 0u);
        }
        for (const auto& e : b.download(c.irradiance))
            EXPECT_TRUE(std::isfinite(e.x) && std::isfinite(e.y) && std::isfinite(e.z));
    }
    this->report("F8", "estimates that 30 poisoned photons change in any bit:", static_cast<double>(different));
}

TYPED_TEST_P(algorithms, a_search_can_be_watched_and_resumed)
{
    auto& b = this->b();
    const auto set = make_photons(distribution::clustered, 5000, {12, 12, 12}, 2);
    const auto points = make_points(set, 2000, 2);
    const auto at = b.upload(std::span<const vec4>(points));
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const auto settings
        = as_paper(knn_settings{.k = 200, .max_radius = 0.3f, .visits_per_pass = 100, .ranges_per_pass = 20});
    const auto whole = knn_grid_estimate(b, map, at, settings);

    knn_search<typename TestFixture::B> search(b, map, at, settings);
    std::vector<std::uint64_t> active;
    std::vector<uvec2> before(points.size());
    for (int pass = 0; pass < 10000; ++pass) {
        const auto p = search.advance(1);
        if (p.passes == 1) {
            ASSERT_EQ(p.active.size(), 1u);
            active.push_back(p.active[0]);
        }
        const auto now = b.download(search.estimates().used);
        for (std::size_t q = 0; q < now.size(); ++q)
            ASSERT_GE(now[q].y, before[q].y); // it only goes forward
        before = now;
        if (p.finished)
            break;
    }
    ASSERT_GT(active.size(), 5u);
    EXPECT_EQ(active.front(), points.size());
    EXPECT_LT(active.back(), points.size() / 2); // it ends early where it can: invocations fall as elements finish
    EXPECT_TRUE(std::is_sorted(active.rbegin(), active.rend()));
    EXPECT_EQ(count_different_bits(b.download(search.estimates().irradiance), b.download(whole.irradiance)), 0u);
    EXPECT_EQ(count_different_bits(b.download(search.estimates().used), b.download(whole.used)), 0u);
    EXPECT_TRUE(search.advance(5).finished);
}

TYPED_TEST_P(algorithms, all_photons_in_one_cell_are_all_visited)
{
    // 70,000 photons in one cell: more than the 65,535 iterations after which llvmpipe and lavapipe end loops in
    // silence.
    auto& b = this->b();
    photon_set set;
    set.g = make_grid(glm::vec3(0), glm::vec3(1), {3, 3, 3});
    set.positions.assign(70000, vec4(0.5f, 0.5f, 0.5f, 0.0f));
    set.powers.assign(70000, vec4(0x1p-20f));
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const auto points = std::vector<vec4>(100, vec4(0.51f, 0.5f, 0.5f, 1.0f));
    const auto e = knn_grid_estimate(
        b, map, b.upload(std::span<const vec4>(points)), as_paper(knn_settings{.k = 100000, .max_radius = 0.5f}));
    for (const auto& u : b.download(e.used))
        ASSERT_EQ(u, uvec2(70000, 70000));
    const auto irradiance = b.download(e.irradiance);
    for (const auto& v : irradiance)
        ASSERT_EQ(v.x, irradiance[0].x);
    const double expected = 70000 * 0x1p-20 / (M_PI * 0.25);
    EXPECT_NEAR(irradiance[0].x, expected, 1e-6);
    this->report("A15", "relative error of irradiance of 70,000 photons in one cell:",
        std::abs(static_cast<double>(irradiance[0].x) / expected - 1));
}

// --- against the specification
// ----------------------------------------------------------------------------------------

TYPED_TEST_P(algorithms, everything_equals_the_serial_backend_bit_for_bit)
{
    auto& b = this->b();
    serial_backend serial;
    for (const auto d : all_distributions)
        for (const auto resolution : {uvec3(1, 1, 1), uvec3(40, 1, 40), uvec3(9, 9, 18)})
            for (const uint m : {0u, 2u, 16u}) {
                const auto set = make_photons(d, 5000, resolution, 11);
                const auto points = make_points(set, 700, 11);
                const auto run = [&](auto& device) {
                    const auto map = m == 0 ? sorted_map(device, upload_photons(device, set), set.g)
                                            : routed_map(device, upload_photons(device, set), set.g, m, 6);
                    const auto e = knn_grid_estimate(device, map, device.upload(std::span<const vec4>(points)),
                        as_paper(knn_settings{.k = 64, .max_radius = 0.25f}));
                    return std::tuple{device.download(map.cells), device.download(map.list),
                        device.download(map.photons.powers), device.download(e.irradiance), device.download(e.used)};
                };
                const auto [cells, list, powers, irradiance, used] = run(b);
                const auto [cells_s, list_s, powers_s, irradiance_s, used_s] = run(serial);
                const std::string where = std::string(name_of(d)) + " m " + std::to_string(m);
                EXPECT_EQ(count_different_bits(cells, cells_s), 0u) << where;
                EXPECT_EQ(count_different_bits(list, list_s), 0u) << where;
                EXPECT_EQ(count_different_bits(used, used_s), 0u) << where;
                std::size_t radii = 0;
                for (std::size_t i = 0; i < irradiance.size(); ++i)
                    radii += irradiance[i].w != irradiance_s[i].w ? 1u : 0u;
                EXPECT_EQ(radii, 0u) << where;
                // Light: the redistributed powers and the estimate divide, so only where that rounds correctly are they
                // equal.
                if (b.caps().exact_division) {
                    EXPECT_EQ(count_different_bits(powers, powers_s), 0u) << where;
                }
                if (b.caps().exact_division && adds_as_serial<TypeParam>()) {
                    EXPECT_EQ(count_different_bits(irradiance, irradiance_s), 0u) << where;
                }
                for (std::size_t i = 0; i < irradiance.size(); ++i)
                    for (int c = 0; c < 3; ++c)
                        ASSERT_NEAR(irradiance[i][c], irradiance_s[i][c], 1e-5f * irradiance_s[i][c]) << where;
            }
}

TYPED_TEST_P(algorithms, a_fitting_grid_suits_any_photons)
{
    auto& b = this->b();
    serial_backend serial;
    for (const auto d : all_distributions)
        for (const std::size_t n : {0u, 1u, 2u, 100u, 20000u}) {
            auto set = make_photons(d, n, {4, 4, 4}, 5);
            if (n == 20000u) { // some stray, some poisoned
                for (std::size_t i = 0; i < 10; ++i)
                    set.positions[i * 1999] = vec4(1e6f, -1e6f, 1e5f * static_cast<float>(i), 0.0f);
                set.positions[7].x = std::numeric_limits<float>::quiet_NaN();
                set.positions[8].y = std::numeric_limits<float>::infinity();
            }
            const auto where = std::string(name_of(d)) + ", " + std::to_string(n) + " photons";
            const auto p = upload_photons(b, set);
            const grid g = fitting_grid(b, p, 50);
            const grid same = fitting_grid(serial, upload_photons(serial, set), 50);
            ASSERT_TRUE(g.origin == same.origin && g.cell == same.cell && g.inverse_cell == same.inverse_cell
                && g.resolution == same.resolution)
                << where;
            ASSERT_LE(cell_count(g), std::max<double>(1.25 * static_cast<double>(n), 64)) << where;
            if (n == 20000u && d != distribution::coincident) {
                ASSERT_GT(cell_count(g), 50u) << where; // strays have not made one cell of all
            }

            // Whatever grid it is, the search is exact in it.
            const auto points = make_points(set, 40, 5);
            const auto map = sorted_map(b, upload_photons(b, set), g);
            const auto e = b.download(
                knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), {.k = 50, .max_radius = 1})
                    .irradiance);
            for (std::size_t q = 0; q < points.size(); ++q) {
                std::vector<float> distances;
                for (const auto& photon : set.positions)
                    if (const float d2 = distance2(photon, points[q]); d2 <= 1)
                        distances.push_back(d2);
                std::sort(distances.begin(), distances.end());
                if (std::isfinite(points[q].x) && std::isfinite(points[q].y)) {
                    ASSERT_EQ(e[q].w, distances.size() >= 50 ? distances[49] : 1.0f) << where << ", point " << q;
                }
            }
        }

    // Cells are about as wide as the k-th distance, half as wide along x: photons on a plane have a known one.
    const auto plane = make_photons(distribution::planar, 50000, {4, 4, 4}, 6);
    const grid g = fitting_grid(b, upload_photons(b, plane), 50);
    const double kth = std::sqrt(50 / (M_PI * 50000));
    EXPECT_EQ(g.resolution.y, 1u);
    EXPECT_NEAR(g.cell.z, kth, 0.25 * kth);
    EXPECT_NEAR(g.cell.x, 0.5 * kth, 0.125 * kth);
}

REGISTER_TYPED_TEST_SUITE_P(algorithms, a_fitting_grid_suits_any_photons, buffers_keep_every_bit,
    a_pass_outside_a_buffer_is_refused, memory_is_accounted_for,
    the_self_test_of_arithmetic_agrees_with_the_capabilities,
    no_photon_lies_beyond_the_last_of_more_cells_than_floats_count, sort_equals_std_sort_for_any_size_and_keys,
    sort_handles_the_sizes_where_networks_break, the_generic_sort_is_right_where_another_stands_for_it,
    sort_reports_the_papers_numbers_of_passes, long_a_million_pairs_sort_and_index, index_equals_the_histogram,
    route_keeps_the_first_in_draw_order_and_all_the_flux, route_conserves_unequal_powers_and_absent_channels,
    route_takes_a_hundred_thousand_photons_to_one_cell, route_conserves_flux_in_crowded_cells,
    route_is_fair_to_later_photons, a_map_of_one_part_of_the_light_holds_that_part, route_says_no_to_what_it_cannot_do,
    estimate_uses_exactly_the_photons_within_its_radius, estimate_adds_up_the_flux_it_says,
    estimate_defines_what_has_no_neighbours, coincident_photons_give_a_finite_estimate,
    poisoned_photons_are_counted_and_harmless, a_search_can_be_watched_and_resumed,
    all_photons_in_one_cell_are_all_visited, everything_equals_the_serial_backend_bit_for_bit);

} // namespace photongrid::testing
