// Every kind of search finds the photons that brute force and FLANN find, on any backend.
#pragma once

#include "../map/photon_generator.hpp"
#include "estimators.hpp"

#include <limits>
#include <set>

namespace photongrid::testing {

TYPED_TEST_P(estimators, every_setting_equals_brute_force)
{
    const auto s = make_oriented(distribution::box_faces, 900, {6, 6, 12}, 60, 3);
    const typename TestFixture::known_map maps[]
        = {this->known(s, map_kind::sorted), this->known(s, map_kind::routed), this->known(s, map_kind::blocks)};
    for (std::size_t i = 0; i < std::size(all_policies); ++i) {
        static_assert(std::size(all_policies) >= std::size(filters));
        const knn_settings k{.k = 30,
            .max_radius = 0.4f,
            .min_radius = 1e-6f,
            .search = all_searches[i % std::size(all_searches)],
            .filter = filters[i % std::size(filters)].kind,
            .bias = all_biases[i % std::size(all_biases)],
            .leaks = all_policies[i]};
        for (const auto& map : maps)
            ASSERT_EQ(this->difference(s, map, k), "")
                << "policy " << i << (map.map.has_blocks() ? ", block map" : ", grid map");
    }
}

TYPED_TEST_P(estimators, radii_at_points_equal_brute_force)
{
    auto s = make_oriented(distribution::box_faces, 900, {6, 6, 12}, 60, 3);
    const float radii[] = {0.0625f, 0.25f, 0.125f, 0.5f, 0.03125f};
    for (std::size_t q = 0; q < s.points.size(); ++q)
        s.points[q].w = std::pow(radii[q % std::size(radii)], 2.0f);
    for (const auto kind : all_maps) {
        const auto map = this->known(s, kind);
        for (const auto& leaks : all_policies)
            for (const float most : {0.25f, std::numeric_limits<float>::infinity()}) {
                const knn_settings k{.k = 30,
                    .max_radius = most,
                    .min_radius = 1e-6f,
                    .search = search_kind::fixed_radius,
                    .radii_at_points = true,
                    .filter = filter_kind::silverman,
                    .leaks = leaks};
                ASSERT_EQ(this->difference(s, map, k), "") << name_of(kind) << ", at most " << most;
            }
    }
}

TYPED_TEST_P(estimators, half_spaces_equal_brute_force)
{
    auto s = make_oriented(distribution::box_faces, 900, {6, 6, 12}, 120, 3);
    random_source u(5);
    double off_way = 0, off_share = 0;
    for (std::size_t q = 0; q < s.points.size(); ++q) {
        s.points[q].w = 0.0625f;
        auto& normal = s.point_normals[q];
        normal.w = 0;
        if (q % 4 == 0)
            continue; // no plane
        const glm::vec3 n(normal);
        const float angle = 6.2831853f * u(), share = q % 4 == 1 ? 0.0f : u();
        const auto basis = kernels::basis_about(n);
        const glm::vec3 way = std::cos(angle) * basis.u + std::sin(angle) * basis.v;
        normal.w = kernels::half_space_code(n, 3.0f * way, share);
        const auto [along, far] = half_space_by_force(normal, 1);
        off_way = std::max(off_way, glm::length(along - glm::dvec3(way)));
        off_share = std::max(off_share, std::abs(far - static_cast<double>(share)));
    }
    EXPECT_LT(off_way, 0.1 * M_PI / 180);
    EXPECT_LT(off_share, 0.0002);
    for (const auto kind : all_maps) {
        const auto map = this->known(s, kind);
        for (const auto& leaks : all_policies) {
            const knn_settings k{.max_radius = 1,
                .min_radius = 1e-6f,
                .search = search_kind::fixed_radius,
                .radii_at_points = true,
                .filter = filter_kind::silverman,
                .leaks = leaks,
                .half_spaces = true};
            ASSERT_EQ(this->difference(s, map, k), "") << name_of(kind);
        }
    }
}

TYPED_TEST_P(estimators, every_combination_equals_brute_force)
{
    const auto s = make_oriented(distribution::box_faces, 900, {6, 6, 12}, 60, 3);
    for (const auto kind : all_maps) {
        const auto map = this->known(s, kind);
        for (const auto search : all_searches)
            for (const auto& f : filters)
                for (const auto bias : all_biases)
                    for (const auto& leaks : all_policies) {
                        knn_settings k{.k = 30, .max_radius = 0.4f, .min_radius = 1e-6f};
                        k.search = search;
                        k.filter = f.kind;
                        k.bias = bias;
                        k.leaks = leaks;
                        ASSERT_EQ(this->difference(s, map, k), "")
                            << name_of(kind) << " search " << int(search) << " filter " << f.name << " bias "
                            << int(bias) << " side " << leaks.side << " cosine " << leaks.min_cosine << " flattening "
                            << leaks.flattening;
                    }
    }
    this->report("A10_policies",
        "largest relative error of irradiance, every search, filter, bias and policy:", this->largest_error_);
}

TYPED_TEST_P(estimators, exact_k_finds_flanns_photons_on_every_distribution)
{
    auto& b = this->b();
    EXPECT_TRUE(rc::check("k-th squared distance = FLANN's bit for bit, set = brute force, ties by id", [&] {
        const auto d = *any_distribution();
        const auto resolution
            = *rc::gen::element(uvec3(1, 1, 1), uvec3(20, 1, 20), uvec3(5, 5, 10), uvec3(1, 1, 40), uvec3(7, 3, 2));
        const auto numbers = *photon_numbers(700);
        const auto k = *rc::gen::element(1u, 2u, 3u, 8u, 50u, 333u, 5000u);
        const auto radius = *rc::gen::element(1e-4f, 0.03f, 0.2f, 0.7f, 10.0f);
        const auto visits = *rc::gen::element(1u, 64u, 3072u);
        const auto s = make_oriented(d, numbers, resolution, 30);
        knn_settings settings{.k = k, .max_radius = radius, .min_radius = 1e-9f};
        settings.bias = bias_kind::paper;
        settings.visits_per_pass = visits;
        settings.ranges_per_pass = visits == 1 ? 2 : 1023;
        const auto kind = *rc::gen::element(map_kind::sorted, map_kind::blocks);
        const auto what = this->difference(s, this->known(s, kind), settings);
        if (!what.empty())
            RC_FAIL(what);

        if (numbers.size() >= k) {
            const auto map = make_map(b, kind, upload_photons(b, s), s.photons.g);
            const auto irradiance
                = b.download(knn_grid_estimate(b, map, b.upload(std::span<const vec4>(s.points)), settings).irradiance);
            const auto known = kth_by_flann(s.photons.positions, s.points, k);
            for (std::size_t q = 0; q < s.points.size(); ++q) {
                RC_ASSERT(known[q].has_value());
                const float kth = *known[q] < std::numeric_limits<float>::min() ? 0.0f : *known[q];
                if (kth <= radius * radius)
                    RC_ASSERT(irradiance[q].w == kth);
            }
        }
    }));
}

TYPED_TEST_P(estimators, ties_at_the_kth_distance_go_by_id)
{
    // 70,000 photons at one point, 20 nearer: of the k = 520 nearest, 500 are the tied ones with the smallest ids.
    auto& b = this->b();
    photon_set set;
    set.g = make_grid(glm::vec3(0), glm::vec3(1), {3, 3, 3});
    random_source u(5);
    for (uint i = 0; i < 70020; ++i) {
        const bool nearer = i % 3501 == 17;
        set.positions.emplace_back(nearer ? 0.5f : 0.75f, 0.5f, 0.5f, 0.0f);
        set.powers.emplace_back(u(), u(), u(), 0.0f);
    }
    knn_settings settings{.k = 520, .max_radius = 1};
    settings.bias = bias_kind::paper;
    const std::vector<vec4> points(1, vec4(0.5f, 0.5f, 0.5f, 1.0f));
    glm::dvec3 power(0);
    uint tied = 0;
    for (uint i = 0; i < 70020; ++i) {
        const bool nearer = i % 3501 == 17;
        if (nearer || tied++ < 500)
            power += glm::dvec3(set.powers[i]);
    }
    double largest = 0;
    for (const auto kind : exact_maps) {
        const auto map = make_map(b, kind, upload_photons(b, set), set.g);
        const auto e = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), settings);
        EXPECT_EQ(b.download(e.used)[0].x, 520u) << name_of(kind);
        const auto irradiance = b.download(e.irradiance)[0];
        EXPECT_EQ(irradiance.w, 0.0625f) << name_of(kind);
        for (int c = 0; c < 3; ++c) {
            const double expected = power[c] / (M_PI * 0.0625);
            largest = std::max(largest, std::abs(static_cast<double>(irradiance[c]) / expected - 1));
            EXPECT_NEAR(irradiance[c], expected, 2e-6 * expected) << name_of(kind);
        }
    }
    this->report("F3", "relative error of irradiance of the 520 nearest of 70,020, 70,000 of them tied:", largest);
}

TYPED_TEST_P(estimators, ties_in_many_cells_go_by_id)
{
    // A lattice has dozens of photons at the same distance, here with ids that have nothing to do with their cells.
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(0), glm::vec3(1), {5, 4, 5});
    for (int i = 0; i < 729; ++i)
        s.photons.positions.emplace_back(0.125f * static_cast<float>(i % 9), 0.125f * static_cast<float>(i / 9 % 9),
            0.125f * static_cast<float>(i / 81), 0.0f);
    random_source u(8);
    for (uint i = 728; i > 0; --i)
        std::swap(s.photons.positions[i], s.photons.positions[u.below(i + 1)]);
    for (int i = 0; i < 729; ++i)
        s.photons.powers.emplace_back(u(), u(), u(), 0.0f);
    for (int i = 0; i < 125; ++i)
        s.points.emplace_back(0.25f * static_cast<float>(i % 5), 0.25f * static_cast<float>(i / 5 % 5),
            0.25f * static_cast<float>(i / 25), 1.0f);
    s.directions.assign(729, vec4(0, -1, 0, 0));
    s.normals.assign(729, vec4(0, 1, 0, 0));
    s.point_normals.assign(125, vec4(0, 1, 0, 0));
    for (const auto kind : exact_maps) {
        const auto map = this->known(s, kind);
        for (const uint k : {1u, 4u, 13u, 50u})
            for (const auto bias : all_biases) {
                knn_settings settings{.k = k, .max_radius = 2, .min_radius = 1e-3f};
                settings.bias = bias;
                EXPECT_EQ(this->difference(s, map, settings), "") << "k " << k << " bias " << int(bias);
            }
    }
}

TYPED_TEST_P(estimators, ties_of_repeated_photons_go_by_id)
{
    // A routed map keeps 9 of 40 photons at one place, each four or five times: the last id that counts does so as
    // often as k asks for. Two photons of the next cell are nearer to some of the points.
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(0), glm::vec3(1), {3, 3, 3});
    random_source u(12);
    for (int i = 0; i < 42; ++i) {
        s.photons.positions.emplace_back(i < 40 ? 0.5f : 0.6875f, 0.5f, 0.5f, 0.0f);
        s.photons.powers.emplace_back(u(), u(), u(), 0.0f);
    }
    for (const float x : {0.25f, 0.5f, 0.625f, 0.75f})
        s.points.emplace_back(x, 0.5f, 0.5f, 1.0f);
    s.directions.assign(42, vec4(0, -1, 0, 0));
    s.normals.assign(42, vec4(0, 1, 0, 0));
    s.point_normals.assign(4, vec4(0, 1, 0, 0));
    const auto map = this->known(s, map_kind::routed);
    ASSERT_EQ(map.ids.size(), 42u);
    ASSERT_EQ(std::set(map.ids.begin(), map.ids.end()).size(), 11u);
    for (const uint k : {1u, 4u, 5u, 6u, 8u, 13u, 24u, 40u, 41u, 42u})
        for (const auto bias : all_biases) {
            knn_settings settings{.k = k, .max_radius = 1, .min_radius = 1e-3f};
            settings.bias = bias;
            EXPECT_EQ(this->difference(s, map, settings), "") << "k " << k << " bias " << int(bias);
        }
}

TYPED_TEST_P(estimators, squared_distances_too_small_for_a_float_count_as_zero)
{
    // Points that follow each other, so close to a photon that from one to the next its squared distance underflows.
    this->compares_biases_ = false;
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(0), glm::vec3(1), {3, 3, 3});
    s.photons.positions = {{0.5f, 0, 0, 0}, {1.1e-19f, 0, 0, 0}, {0.25f, 0, 0, 0}, {1.12e-19f, 0, 0, 0}};
    s.photons.powers = {{1, 2, 3, 0}, {5, 7, 11, 0}, {13, 17, 19, 0}, {23, 29, 31, 0}};
    for (int i = 0; i < 20; ++i)
        s.points.emplace_back(static_cast<float>(i) * 5e-21f, 0.0f, 0.0f, 1.0f);
    s.directions.assign(4, vec4(0, -1, 0, 0));
    s.normals.assign(4, vec4(0, 1, 0, 0));
    s.point_normals.assign(20, vec4(0, 1, 0, 0));
    for (const auto kind : exact_maps) {
        const auto map = this->known(s, kind);
        for (const uint k : {1u, 2u, 3u}) {
            knn_settings settings{.k = k, .max_radius = 1, .min_radius = 1e-3f};
            settings.bias = bias_kind::paper;
            EXPECT_EQ(this->difference(s, map, settings), "") << "k " << k;
        }
    }
}

TYPED_TEST_P(estimators, photons_within_the_least_radius_are_all_summed)
{
    // Some points have their k-th photon at their own place or within min_radius of it: it counts, also unbiased, and
    // is a term of the standard error. For other points it is excluded.
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(0), glm::vec3(1), {2, 2, 2});
    random_source u(21);
    for (int i = 0; i < 12; ++i) {
        const float x = i < 6 ? 0.25f : i < 9 ? 0.25f + 0.01f * u() : 0.75f;
        s.photons.positions.emplace_back(x, 0.25f, 0.25f, 0.0f);
        s.photons.powers.emplace_back(1 + u(), 1 + u(), 1 + u(), 0.0f);
    }
    s.points = {{0.25f, 0.25f, 0.25f, 1.0f}, {0.255f, 0.25f, 0.25f, 1.0f}, {0.5f, 0.25f, 0.25f, 1.0f}};
    s.directions.assign(12, vec4(0, -1, 0, 0));
    s.normals.assign(12, vec4(0, 1, 0, 0));
    s.point_normals.assign(3, vec4(0, 1, 0, 0));
    for (const auto kind : exact_maps) {
        const auto map = this->known(s, kind);
        for (const auto search : {search_kind::exact_k, search_kind::at_least_k})
            for (const auto& f : filters)
                for (const uint k : {1u, 2u, 3u, 4u, 5u, 10u, 12u}) {
                    const knn_settings settings{
                        .k = k, .max_radius = 2, .min_radius = 0.0625f, .search = search, .filter = f.kind};
                    EXPECT_EQ(this->difference(s, map, settings), "")
                        << "k " << k << " filter " << f.name << " search " << int(search);
                }
    }
}

TYPED_TEST_P(estimators, estimates_in_small_clusters_ignore_far_photons)
{
    // Clusters from 1e-3 to 1e-9 m about 0, and photons 1e6 m away. Without them the estimates would be the same: the
    // least radius of a disc follows the point's own coordinates, by which rounding moves photons there.
    this->compares_biases_ = false;
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(-1), glm::vec3(1e6f), {4, 4, 4});
    random_source u(31);
    for (int i = 0; i < 1200; ++i) {
        const float size = i % 3 == 0 ? 1e-3f : i % 3 == 1 ? 1e-6f : 1e-9f, x = size * (u() - 0.5f);
        s.photons.positions.emplace_back(x, size * (u() - 0.5f), i % 50 == 0 ? 1e6f : 0.0f, 0.0f);
        s.photons.powers.emplace_back(1 + u(), 1 + u(), 1 + u(), 0.0f);
        if (i % 40 < 3)
            s.points.emplace_back(x, size * (u() - 0.5f), 0.0f, 1.0f);
    }
    s.directions.assign(1200, vec4(0, -1, 0, 0));
    s.normals.assign(1200, vec4(0, 1, 0, 0));
    s.point_normals.assign(s.points.size(), vec4(0, 1, 0, 0));
    for (const auto kind : exact_maps) {
        const auto map = this->known(s, kind);
        for (const auto search : all_searches) // seen from afar, a cluster has one distance: other filters round badly
            EXPECT_EQ(this->difference(s, map, {.k = 10, .max_radius = 1e-2f, .search = search}), "")
                << "search " << int(search);
    }
}

TYPED_TEST_P(estimators, discs_are_no_smaller_than_rounding_moves_photons)
{
    // Photons in one place at several distances from 0: the disc's radius is 2^-24 of the point's largest coordinate,
    // or min_radius where that is larger.
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(-100), glm::vec3(100), {4, 4, 4});
    random_source u(32);
    for (const glm::vec3 place :
        {glm::vec3(0), glm::vec3(0.25f, -3, 1), glm::vec3(1e-12f, 0, -1e-9f), glm::vec3(64, 1, 99)})
        for (int i = 0; i < 12; ++i) {
            s.photons.positions.emplace_back(place, 0.0f);
            s.photons.powers.emplace_back(1 + u(), 1 + u(), 1 + u(), 0.0f);
            if (i == 0)
                s.points.emplace_back(place, 1.0f);
        }
    s.directions.assign(48, vec4(0, -1, 0, 0));
    s.normals.assign(48, vec4(0, 1, 0, 0));
    s.point_normals.assign(s.points.size(), vec4(0, 1, 0, 0));
    for (const auto kind : exact_maps) {
        const auto map = this->known(s, kind);
        for (const auto search : {search_kind::exact_k, search_kind::at_least_k})
            for (const float least : {0.0f, -1.0f, 1e-7f}) {
                const knn_settings settings{.k = 12, .max_radius = 2, .min_radius = least, .search = search};
                EXPECT_EQ(this->difference(s, map, settings), "") << "search " << int(search) << " least " << least;
            }
    }
}

/// Photons and points at places that RapidCheck draws and shrinks, NaN, infinity and denormals among them. Photons that
/// are not finite are in no map. Whole numbers as powers tell by their sums which photons an estimate has.
TYPED_TEST_P(estimators, find_the_photons_of_brute_force_for_any_numbers)
{
    auto& b = this->b();
    EXPECT_TRUE(rc::check("k-th distance, number and sum of photons equal brute force, whatever the numbers", [&] {
        photon_set s;
        s.positions = *rc::gen::resize(200, any_vectors(0));
        const auto invalid = *rc::gen::element(std::numeric_limits<float>::quiet_NaN(),
            std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity());
        for (uint id = 0; id < s.positions.size(); ++id)
            s.powers.emplace_back(
                1.0f, static_cast<float>(id), id % 11 == 10 ? invalid : static_cast<float>(id * 37 % 101), 0.0f);
        s.g = make_grid(glm::vec3(-1), glm::vec3(1),
            {*rc::gen::inRange(1u, 9u), *rc::gen::inRange(1u, 9u), *rc::gen::inRange(1u, 9u)});
        const auto points = *rc::gen::resize(20, any_vectors(1));
        knn_settings settings{.k = *rc::gen::inRange(1u, 40u),
            .max_radius = *rc::gen::element(0.0f, 0.125f, 0.7f, 5.0f, 1e20f, std::numeric_limits<float>::infinity()),
            .min_radius = 1e-3f};
        settings.search = *rc::gen::element(search_kind::exact_k, search_kind::at_least_k);
        settings.bias = *rc::gen::element(bias_kind::paper, bias_kind::unbiased);
        const auto kind = *rc::gen::element(map_kind::sorted, map_kind::blocks);
        const auto map = make_map(b, kind, upload_photons(b, s), s.g);
        const auto wrong = this->other_photons(s, map, points, settings);
        if (!wrong.empty())
            RC_FAIL(wrong);
    }));
}

/// Photons in up to four clumps of any extents and distances, and points in the same clumps, some of them photons.
TYPED_TEST_P(estimators, find_the_photons_of_brute_force_in_any_clumps)
{
    auto& b = this->b();
    EXPECT_TRUE(rc::check("k-th distance, number and sum of photons equal brute force, however photons lie", [&] {
        const auto clumps = *rc::gen::suchThat(rc::gen::resize(4, rc::gen::container<std::vector<clump>>(any_clump())),
            [](const auto& c) { return !c.empty(); });
        photon_set s;
        s.positions = *up_to(300, place_in(clumps, 0));
        for (uint id = 0; id < s.positions.size(); ++id)
            s.powers.emplace_back(1.0f, static_cast<float>(id), static_cast<float>(id * 37 % 101), 0.0f);
        s.g = make_grid(glm::vec3(-1), glm::vec3(1), glm::uvec3(*rc::gen::inRange(1u, 9u)));
        auto points = *up_to(12, place_in(clumps, 1));
        for (std::size_t id = 0; id < s.positions.size(); id += 37)
            points.emplace_back(glm::vec3(s.positions[id]), 1.0f);
        knn_settings settings{.k = *rc::gen::element(1u, 2u, 10u, 50u),
            .max_radius = *rc::gen::element(std::numeric_limits<float>::infinity(), 1.0f, 1e-6f, 1e8f),
            .min_radius = 1e-3f};
        settings.search = *rc::gen::element(search_kind::exact_k, search_kind::at_least_k);
        const auto map = *rc::gen::arbitrary<bool>()  ? block_map(b, upload_photons(b, s))
            : settings.search == search_kind::exact_k ? fitted_map(b, upload_photons(b, s), settings.k)
                                                      : sorted_map(b, upload_photons(b, s), s.g);
        const auto wrong = this->other_photons(s, map, points, settings);
        if (!wrong.empty())
            RC_FAIL(wrong);
    }));
}

TYPED_TEST_P(estimators, distances_next_to_each_other_are_told_apart)
{
    // Squared distances two roundings apart, some of them twice: every pivot of the k-th's search lies at a photon or
    // next to one.
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(0), glm::vec3(2), {1, 1, 1});
    random_source u(31);
    for (int i = 0; i < 300; ++i) {
        s.photons.positions.emplace_back(1 + static_cast<float>(u.below(200)) * 0x1p-23f, 0.0f, 0.0f, 0.0f);
        s.photons.powers.emplace_back(u(), u(), u(), 0.0f);
    }
    s.points = {{0.0f, 0.0f, 0.0f, 1.0f}};
    s.point_normals = {{0.0f, 1.0f, 0.0f, 0.0f}};
    for (const auto kind : exact_maps) {
        const auto map = this->known(s, kind);
        for (uint k = 1; k <= 300; k += 13) {
            knn_settings settings{.k = k, .max_radius = 2};
            settings.bias = bias_kind::paper;
            EXPECT_EQ(this->difference(s, map, settings), "") << "k " << k;
        }
    }
}

} // namespace photongrid::testing
