// Lists of nearest neighbours. References: brute force over all photons, sorted by distance and id; FLANN's distances.
// Included by each on_<backend>.cpp.
#pragma once

#include "../core/under_test.hpp"
#include "../map/photon_generator.hpp"
#include "../map/photon_sets.hpp"
#include "known_answers.hpp"

#include <photongrid/estimate/knn_neighbours.hpp>

#include <rapidcheck.h>

#include <algorithm>
#include <limits>

namespace photongrid::testing {

/// A list as the host sees it.
struct listed {
    std::vector<uint> ids;
    std::vector<float> distances2;
    bool operator==(const listed&) const = default;
};

/// The k nearest of the photons in the map by brute force, in the list's order.
inline listed listed_by_force(
    const oriented_set& s, const std::vector<uint>& in_map, std::size_t q, const knn_settings& settings)
{
    std::vector<std::pair<float, uint>> all;
    const float max_radius2 = std::min(settings.max_radius * settings.max_radius, 1e38f);
    const bool is_point = s.points[q].w > 0 && std::isfinite(s.points[q].x) && std::isfinite(s.points[q].y)
        && std::isfinite(s.points[q].z);
    for (const uint id : in_map)
        if (const auto d2 = policy_distance2(s, q, id, settings.leaks);
            is_point && settings.max_radius > 0 && d2 && *d2 <= max_radius2)
            all.emplace_back(*d2, id);
    std::sort(all.begin(), all.end());
    all.resize(std::min<std::size_t>(all.size(), settings.k));
    listed l;
    for (const auto& [d2, id] : all) {
        l.distances2.push_back(d2);
        l.ids.push_back(id);
    }
    l.ids.resize(settings.k, no_id);
    l.distances2.resize(settings.k, std::numeric_limits<float>::infinity());
    return l;
}

template <class Tag>
class neighbours : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    map_buffers<B> map_of(const oriented_set& s, map_kind kind = map_kind::sorted)
    {
        auto& b = this->b();
        auto p = upload_photons(b, s.photons);
        p.directions = b.upload(std::span<const glm::vec4>(s.directions));
        p.normals = b.upload(std::span<const glm::vec4>(s.normals));
        return make_map(b, kind, std::move(p), s.photons.g, 3, 5);
    }
    std::vector<uint> ids_of(const map_buffers<B>& map)
    {
        std::vector<uint> ids;
        for (const auto& some : ids_in(this->b(), map))
            ids.insert(ids.end(), some.begin(), some.end());
        return ids;
    }
    /// The lists of all points of `s`, row by row.
    std::vector<listed> lists(const map_buffers<B>& map, const oriented_set& s, const knn_settings& settings)
    {
        auto& b = this->b();
        const auto points = b.upload(std::span<const glm::vec4>(s.points));
        const auto normals = b.upload(std::span<const glm::vec4>(s.point_normals));
        const auto found = knn_neighbours(b, map, points, normals, settings);
        EXPECT_EQ(found.k, settings.k);
        const auto ids = b.download(found.ids);
        const auto distances2 = b.download(found.distances2);
        EXPECT_EQ(ids.size(), s.points.size() * settings.k);
        EXPECT_EQ(distances2.size(), ids.size());
        std::vector<listed> rows(s.points.size());
        for (std::size_t q = 0; q < rows.size(); ++q) {
            const auto first = static_cast<std::ptrdiff_t>(q * settings.k),
                       past = first + static_cast<std::ptrdiff_t>(settings.k);
            rows[q]
                = {{ids.begin() + first, ids.begin() + past}, {distances2.begin() + first, distances2.begin() + past}};
        }
        return rows;
    }
    /// Which list differs from brute force's and how, or nothing.
    std::string difference(const oriented_set& s, const knn_settings& settings, map_kind kind = map_kind::sorted)
    {
        const auto map = map_of(s, kind);
        const auto in_map = ids_of(map);
        const auto rows = lists(map, s, settings);
        for (std::size_t q = 0; q < rows.size(); ++q) {
            const auto expected = listed_by_force(s, in_map, q, settings);
            for (std::size_t n = 0; n < settings.k; ++n)
                if (rows[q].ids[n] != expected.ids[n] || rows[q].distances2[n] != expected.distances2[n])
                    return "neighbour " + std::to_string(n) + " of point " + std::to_string(q) + " is "
                        + std::to_string(rows[q].ids[n]) + " at " + std::to_string(rows[q].distances2[n]) + ", not "
                        + std::to_string(expected.ids[n]) + " at " + std::to_string(expected.distances2[n]);
        }
        return {};
    }
};
TYPED_TEST_SUITE_P(neighbours);

TYPED_TEST_P(neighbours, equal_brute_force_for_any_photons)
{
    EXPECT_TRUE(rc::check("lists of neighbours equal brute force", [&] {
        const auto d = *any_distribution();
        const auto numbers = *photon_numbers(700);
        const glm::uvec3 resolution(*rc::gen::inRange(1u, 12u), *rc::gen::inRange(1u, 12u), *rc::gen::inRange(1u, 12u));
        const auto s = make_oriented(d, numbers, resolution, 40);
        const knn_settings settings{
            .k = *rc::gen::inRange(1u, 70u), .max_radius = static_cast<float>(*rc::gen::inRange(0, 20)) * 0.1f};
        const auto kind = *rc::gen::elementOf(std::vector(std::begin(exact_maps), std::end(exact_maps)));
        const auto wrong = this->difference(s, settings, kind);
        if (!wrong.empty())
            RC_FAIL(wrong + " (" + name_of(d) + ", " + name_of(kind) + ")");
    }));
}

/// Photons and points at places that RapidCheck draws and shrinks, NaN, infinity and denormals among them. Photons with
/// a position or a power that is not finite are in no map.
TYPED_TEST_P(neighbours, equal_brute_force_for_any_numbers)
{
    EXPECT_TRUE(rc::check("lists of neighbours equal brute force, whatever the numbers", [&] {
        oriented_set s;
        s.photons.positions = *rc::gen::resize(300, any_vectors(0));
        const auto powers = *rc::gen::resize(20, any_vectors(0));
        std::vector<uint> valid;
        for (std::size_t i = 0; i < s.photons.positions.size(); ++i) {
            s.photons.powers.push_back(powers.empty() ? glm::vec4(1.0f) : powers[i % powers.size()]);
            if (is_finite(s.photons.positions[i]) && is_finite(s.photons.powers[i]))
                valid.push_back(static_cast<uint>(i));
        }
        s.photons.g = make_grid(glm::vec3(-1), glm::vec3(1),
            {*rc::gen::inRange(1u, 9u), *rc::gen::inRange(1u, 9u), *rc::gen::inRange(1u, 9u)});
        s.directions = s.normals = std::vector<glm::vec4>(s.photons.positions.size(), glm::vec4(0, 0, 1, 0));
        s.points = *rc::gen::resize(40, any_vectors(1));
        s.point_normals = std::vector<glm::vec4>(s.points.size(), glm::vec4(0, 0, 1, 0));
        const auto kind = *rc::gen::elementOf(std::vector(std::begin(exact_maps), std::end(exact_maps)));
        auto in_map = this->ids_of(this->map_of(s, kind));
        std::sort(in_map.begin(), in_map.end());
        RC_ASSERT(in_map == valid);
        const knn_settings settings{.k = *rc::gen::inRange(1u, 40u),
            .max_radius = *rc::gen::element(0.0f, 0.125f, 0.7f, 5.0f, 1e20f, std::numeric_limits<float>::infinity())};
        const auto wrong = this->difference(s, settings, kind);
        if (!wrong.empty())
            RC_FAIL(wrong);
    }));
}

TYPED_TEST_P(neighbours, keep_every_leak_policy)
{
    const auto s = make_oriented(distribution::box_faces, 900, {6, 6, 12}, 60, 3);
    for (const auto kind : all_maps)
        for (const auto& leaks : {leak_policy{}, leak_policy{.side = true}, leak_policy{.min_cosine = 0.3f},
                 leak_policy{.flattening = 3}, leak_policy{.side = true, .min_cosine = -0.5f, .flattening = 1.5f}})
            ASSERT_EQ(this->difference(s, {.k = 30, .max_radius = 0.4f, .leaks = leaks}, kind), "") << name_of(
                kind) << " side " << leaks.side << " cosine " << leaks.min_cosine << " flattening " << leaks.flattening;
}

TYPED_TEST_P(neighbours, of_many_at_one_distance_have_the_smallest_ids)
{
    // 500 photons at two points: every list is a tie. A routed map keeps few of them, and repeats those.
    const auto s = make_oriented(distribution::coincident, 500, {4, 4, 4}, 20, 5);
    for (const auto kind : all_maps)
        for (const uint k : {1u, 3u, 16u, 17u, 64u, 65u, 300u})
            ASSERT_EQ(this->difference(s, {.k = k, .max_radius = 3}, kind), "") << "k " << k << " " << name_of(kind);
}

TYPED_TEST_P(neighbours, lists_as_long_as_there_are_photons_and_longer)
{
    const auto s = make_oriented(distribution::uniform, 200, {5, 5, 5}, 9, 6);
    for (const auto kind : exact_maps)
        for (const uint k : {199u, 200u, 201u, 513u})
            ASSERT_EQ(this->difference(s, {.k = k, .max_radius = 9}, kind), "") << "k " << k << " " << name_of(kind);
}

TYPED_TEST_P(neighbours, distances_are_flanns)
{
    const auto s = make_oriented(distribution::clustered, 20000, {24, 24, 24}, 200, 7);
    const uint k = 40;
    const auto rows = this->lists(this->map_of(s), s, {.k = k, .max_radius = 4});
    for (const uint n : {1u, 7u, 16u, 33u, 40u}) {
        const auto flann = kth_by_flann(s.photons.positions, s.points, n);
        for (std::size_t q = 0; q < rows.size(); ++q)
            ASSERT_NEAR(rows[q].distances2[n - 1], flann[q].value(), 1e-6f * flann[q].value())
                << "neighbour " << n << " of point " << q;
    }
}

TYPED_TEST_P(neighbours, of_no_point_and_of_none_wanted)
{
    auto s = make_oriented(distribution::uniform, 50, {3, 3, 3}, 4, 8);
    s.points[0].w = 0; // no result needed
    s.points[1].x = std::numeric_limits<float>::quiet_NaN();
    s.points[2].y = std::numeric_limits<float>::infinity();
    ASSERT_EQ(this->difference(s, {.k = 5, .max_radius = 9}), "");
    s.points.clear();
    s.point_normals.clear();
    ASSERT_EQ(this->difference(s, {.k = 5, .max_radius = 9}), "");
}

TYPED_TEST_P(neighbours, say_what_is_wrong)
{
    const auto s = make_oriented(distribution::uniform, 50, {3, 3, 3}, 4, 8);
    const auto map = this->map_of(s);
    const auto refusal = [&](const knn_settings& settings) {
        try {
            (void)this->lists(map, s, settings);
        } catch (const std::invalid_argument& e) {
            return std::string(e.what());
        }
        return std::string("none");
    };
    EXPECT_NE(refusal({.k = 0, .max_radius = 1}).find("k: 0"), std::string::npos);
    EXPECT_NE(
        refusal({.k = 5, .max_radius = std::numeric_limits<float>::quiet_NaN()}).find("max_radius"), std::string::npos);
    EXPECT_NE(refusal({.k = 5, .max_radius = 1, .search = search_kind::at_least_k}).find("search"), std::string::npos);
    EXPECT_NE(refusal({.k = 4'000'000'000u, .max_radius = 1}).find("k: 4000000000"), std::string::npos);
}

TYPED_TEST_P(neighbours, of_the_same_photons_are_the_same_with_small_passes)
{
    const auto s = make_oriented(distribution::clustered, 3000, {9, 9, 9}, 50, 9);
    for (const auto kind : exact_maps) {
        const auto map = this->map_of(s, kind);
        EXPECT_EQ(this->lists(map, s, {.k = 50, .max_radius = 2}),
            this->lists(map, s, {.k = 50, .max_radius = 2, .visits_per_pass = 37, .ranges_per_pass = 5}));
    }
}

REGISTER_TYPED_TEST_SUITE_P(neighbours, equal_brute_force_for_any_photons, equal_brute_force_for_any_numbers,
    keep_every_leak_policy, of_many_at_one_distance_have_the_smallest_ids,
    lists_as_long_as_there_are_photons_and_longer, distances_are_flanns, of_no_point_and_of_none_wanted,
    say_what_is_wrong, of_the_same_photons_are_the_same_with_small_passes);

} // namespace photongrid::testing
