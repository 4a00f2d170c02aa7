// The search of photons in a map on any backend.
#pragma once

#include "algorithms.hpp"

namespace photongrid::testing {

TYPED_TEST_P(algorithms, estimate_uses_exactly_the_photons_within_its_radius)
{
    auto& b = this->b();
    EXPECT_TRUE(rc::check("set = brute force, at least k, FLANN's k nearest are in it", [&] {
        const auto d = *any_distribution();
        const auto resolution
            = *rc::gen::element(uvec3(1, 1, 1), uvec3(20, 1, 20), uvec3(5, 5, 10), uvec3(1, 1, 40), uvec3(7, 3, 2));
        const auto numbers = *photon_numbers(700);
        const auto k = *rc::gen::element(1u, 2u, 8u, 50u, 5000u);
        const auto radius = *rc::gen::element(1e-4f, 0.03f, 0.2f, 0.7f, 10.0f);
        const bool routed = *rc::gen::arbitrary<bool>();
        const auto set = make_photons(d, numbers, resolution);
        const auto points = make_points(set, 40, numbers.empty() ? 0 : numbers.front());
        const auto map = routed ? routed_map(b, upload_photons(b, set), set.g, {16, 3})
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
            RC_ASSERT(ids.size() == numbers.size());
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

TYPED_TEST_P(algorithms, estimate_adds_up_the_power_of_its_photons)
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
        glm::dvec3 power(0);
        for (std::size_t i = 0; i < set.positions.size(); ++i)
            if (distance2(points[q], set.positions[i]) <= irradiance[q].w)
                power += glm::dvec3(set.powers[i]);
        const double area = M_PI * static_cast<double>(irradiance[q].w);
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(irradiance[q][c], used[q].x == 0 ? 0 : power[c] / area, 1e-5 * power[c] / area);
            if (power[c] > 0)
                largest = std::max(largest, std::abs(static_cast<double>(irradiance[q][c]) * area / power[c] - 1));
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
    const auto counts = [&](const map_buffers<typename TestFixture::B>& m, knn_settings s) {
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

} // namespace photongrid::testing
