// Stencil routing on any backend.
#pragma once

#include "algorithms.hpp"

namespace photongrid::testing {

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

TYPED_TEST_P(algorithms, route_keeps_the_first_in_draw_order_and_all_power)
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
            std::uint64_t overflowing = 0;
            for (std::size_t c = 0; c < cells.size(); ++c) {
                const uint kept = std::min<uint>(capacity, static_cast<uint>(destined[c].size()));
                overflowing += destined[c].size() > capacity ? 1u : 0u;
                ASSERT_EQ(cells[c], uvec2(c * capacity, kept)) << "cell " << c << " m " << m << " " << name_of(d);
                ASSERT_EQ(totals[c].w, static_cast<float>(destined[c].size()));
                glm::dvec3 before(0), after(0);
                for (uint s = 0; s < capacity; ++s) {
                    ASSERT_EQ(list[c * capacity + s], s < kept ? destined[c][s] : no_id)
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
            EXPECT_EQ(routed.overflowing_cells, overflowing);
        }
    this->report("A1", "relative error of a cell's power:", largest);
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
    this->report("A3", "relative error of power over 12 decades:", largest);
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
    this->report("A2", "relative error of power, 100,000 photons of a power of two in a cell:", largest);
}

TYPED_TEST_P(algorithms, route_conserves_power_in_crowded_cells)
{
    // Float sums of a third: 1e-5 up to 2,048 photons per cell, 5e-4 at 70,000.
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
            "relative error of power, " + std::to_string(n) + " equal photons in a cell:", largest);
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
            const auto map = routed ? routed_map(b, upload_photons(b, set), set.g, {16, 2, parts})
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

TYPED_TEST_P(algorithms, photons_of_a_routed_map_stand_for_those_without_a_slot)
{
    auto& b = this->b();
    for (const uint m : {1u, 3u, 4u, 16u})
        for (const auto d : {distribution::uniform, distribution::clustered, distribution::coincident})
            for (const auto kind : {surplus_kind::photons, surplus_kind::power}) {
                SCOPED_TRACE(
                    std::string(name_of(d)) + " m " + std::to_string(m) + " kind " + std::to_string(int(kind)));
                const uint n = 3000;
                auto set = make_photons(d, n, {6, 5, 4}, m);
                set.positions[n / 2].x = std::numeric_limits<float>::quiet_NaN(); // in no cell
                const auto cell_of = [&](uint id) {
                    return glm::uvec3(glm::clamp(glm::floor((glm::vec3(set.positions[id]) - glm::vec3(set.g.origin))
                                                     * glm::vec3(set.g.inverse_cell)),
                        glm::vec3(0), glm::vec3(5, 4, 3)));
                };
                std::vector<std::vector<uint>> destined(6 * 5 * 4);
                for (uint i = 0; i < n; ++i)
                    if (const uint id = kernels::permuted(i, n, 7); id != n / 2)
                        destined[(cell_of(id).z * 5 + cell_of(id).y) * 6 + cell_of(id).x].push_back(id);

                const auto map = routed_map(b, upload_photons(b, set), set.g, {m, 7, every_part, kind});
                const auto cells = b.download(map.cells);
                const auto list = b.download(map.list);
                const auto positions = b.download(map.photons.positions), powers = b.download(map.photons.powers);
                uint next = 0;
                for (std::size_t c = 0; c < cells.size(); ++c) {
                    const auto arrived = static_cast<uint>(destined[c].size()),
                               kept = std::min(arrived, route_capacity(m));
                    const uint entries = kind == surplus_kind::photons ? arrived : kept;
                    ASSERT_EQ(cells[c], uvec2(next, entries)) << "cell " << c;
                    next += entries;
                    std::map<uint, uint> found;
                    glm::dvec3 before(0), after(0);
                    for (uint at = cells[c].x; at < next; ++at) {
                        ++found[list[at]];
                        after += glm::dvec3(powers[at]);
                        ASSERT_LT(list[at], n);
                        ASSERT_EQ(positions[at], set.positions[list[at]]);
                    }
                    ASSERT_EQ(found.size(), kept);
                    for (uint s = 0; s < kept; ++s) { // the first in draw order, in turn
                        const uint expected = entries / kept + (s < entries % kept ? 1u : 0u);
                        ASSERT_EQ(found[destined[c][s]], expected) << "slot " << s;
                    }
                    for (uint at = cells[c].x; at < next; ++at)
                        ASSERT_EQ(powers[at].w, static_cast<float>(found[list[at]]));
                    for (const uint id : destined[c])
                        before += glm::dvec3(set.powers[id]);
                    for (int channel = 0; channel < 3; ++channel)
                        ASSERT_NEAR(after[channel], before[channel], 1e-5 * before[channel]) << "cell " << c;
                }
                for (uint at = next; at < n; ++at)
                    ASSERT_EQ(list[at], no_id);
                EXPECT_EQ(map.invalid, 1u);
            }
}

TYPED_TEST_P(algorithms, route_throws_for_wrong_arguments)
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

/// A float counts to 2^24, so eight partial sums count to 2^27.
TEST(routing, refuses_more_photons_than_it_can_count)
{
    ASSERT_EQ(0x1p24f + 1.0f, 0x1p24f);
    ASSERT_NE(0x1p24f - 1.0f, 0x1p24f);
    EXPECT_NO_THROW(detail::check_route_count(1u << 27, 8));
    EXPECT_THROW(detail::check_route_count((1u << 27) + 1, 8), std::invalid_argument);
    EXPECT_THROW(detail::check_route_count(0xFFFFFFFFu, 8), std::invalid_argument);
}

// --- knn_grid_estimate
// ------------------------------------------------------------------------------------------------

} // namespace photongrid::testing
