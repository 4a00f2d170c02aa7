// What the estimates promise beyond the paper's: exact k, kernels, bias, leak policies, standard errors. References:
// brute force in double over float distances, FLANN, statistics of uniform fields. Included by each on_<backend>.cpp.
#pragma once

#include "known_answers.hpp"
#include "photon_sets.hpp"
#include "serial_algorithms.hpp"
#include "under_test.hpp"

#include <photongrid/knn_grid_estimate.hpp>

#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace photongrid::testing {

using glm::uvec2;
using glm::uvec3;
using glm::vec4;

inline constexpr search_kind all_searches[]
    = {search_kind::at_least_k, search_kind::exact_k, search_kind::fixed_radius};
inline constexpr filter_kernel all_kernels_of_estimates[]
    = {filter_kernel::constant, filter_kernel::cone, filter_kernel::epanechnikov, filter_kernel::silverman};
inline constexpr bias_kind all_biases[] = {bias_kind::paper, bias_kind::unbiased};
inline const leak_policy all_policies[] = {{}, {.side = true}, {.min_cosine = 0.3f}, {.compression = 3},
    {.side = true, .min_cosine = -0.5f, .compression = 1.5f}};

template <backend B>
photons<B> upload_photons(B& b, const oriented_set& s)
{
    auto p = upload_photons(b, s.photons);
    p.directions = b.upload(std::span<const vec4>(s.directions));
    p.normals = b.upload(std::span<const vec4>(s.normals));
    return p;
}

template <class Tag>
class estimators : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    /// A map, and what brute force has to know of it.
    struct known_map {
        photon_map<B> map;
        std::vector<uint> ids;    ///< of the photons in the map
        std::vector<vec4> powers; ///< by id: routing has changed them
    };
    known_map known(const oriented_set& s, bool routed)
    {
        auto& b = this->b();
        known_map m{routed ? routed_map(b, upload_photons(b, s), s.photons.g, 3, 5)
                           : sorted_map(b, upload_photons(b, s), s.photons.g),
            {}, std::vector<vec4>(s.photons.positions.size())};
        const auto list = b.download(m.map.list);
        const auto stored = b.download(m.map.photons.powers);
        for (const auto& c : b.download(m.map.cells))
            for (uint at = c.x; at < c.x + c.y; ++at) {
                m.ids.push_back(list[at]);
                m.powers[list[at]] = stored[at];
            }
        return m;
    }

    /// Runs one search over a map of `s` and compares every point with brute force; returns what differs, or nothing.
    std::string difference(const oriented_set& s, const known_map& m, knn_settings settings)
    {
        auto& b = this->b();
        // Errors always, but for the paper's own estimate, which has a path of its own without them.
        settings.errors = settings.search != search_kind::at_least_k || settings.kernel != filter_kernel::constant
            || settings.bias != bias_kind::paper;
        const auto points = b.upload(std::span<const vec4>(s.points));
        const auto normals = b.upload(std::span<const vec4>(s.point_normals));
        const auto e = knn_grid_estimate(b, m.map, points, normals, settings);
        const auto irradiance = b.download(e.irradiance);
        const auto used = b.download(e.used);
        const auto standard_error = b.download(e.standard_error);
        for (std::size_t q = 0; q < s.points.size(); ++q) {
            const auto expected = estimate_by_force(s, m.ids, m.powers, q, settings, irradiance[q].w);
            const auto where = " at point " + std::to_string(q);
            if (used[q].x != expected.ids.size())
                return "used " + std::to_string(used[q].x) + ", not " + std::to_string(expected.ids.size()) + where;
            if (static_cast<double>(irradiance[q].w) != expected.radius2)
                return "squared radius " + std::to_string(irradiance[q].w) + ", not " + std::to_string(expected.radius2)
                    + where;
            // The sum is zero or tells the set: powers are random.
            for (int c = 0; c < 3; ++c) {
                const double error = std::abs(static_cast<double>(irradiance[q][c]) - expected.irradiance[c]);
                if (!(error <= 4e-6 * expected.irradiance[c] + 1e-6 * expected.irradiance.x))
                    return "channel " + std::to_string(c) + " is " + std::to_string(irradiance[q][c]) + ", not "
                        + std::to_string(expected.irradiance[c]) + where;
                if (error > 0)
                    largest_error_ = std::max(largest_error_, error / expected.irradiance[c]);
            }
            for (int c = 0; settings.errors && c < 4; ++c)
                if (!(std::abs(static_cast<double>(standard_error[q][c]) - expected.standard_error[c])
                        <= 4e-6 * expected.standard_error[c] + 1e-6 * expected.irradiance.x))
                    return "standard error " + std::to_string(c) + " is " + std::to_string(standard_error[q][c])
                        + ", not " + std::to_string(expected.standard_error[c]) + where;
        }
        return {};
    }

    double largest_error_ = 0; ///< of irradiance, relative, so far
};
TYPED_TEST_SUITE_P(estimators);

TYPED_TEST_P(estimators, every_combination_equals_brute_force)
{
    const auto s = make_oriented(distribution::box_faces, 900, {6, 6, 12}, 60, 3);
    for (const bool routed : {false, true}) {
        const auto map = this->known(s, routed);
        for (const auto search : all_searches)
            for (const auto kernel : all_kernels_of_estimates)
                for (const auto bias : all_biases)
                    for (const auto& leaks : all_policies) {
                        knn_settings k{.k = 30, .max_radius = 0.4f, .min_radius = 1e-6f};
                        k.search = search;
                        k.kernel = kernel;
                        k.bias = bias;
                        k.leaks = leaks;
                        ASSERT_EQ(this->difference(s, map, k), "")
                            << "search " << int(search) << " kernel " << int(kernel) << " bias " << int(bias)
                            << " side " << leaks.side << " cosine " << leaks.min_cosine << " compression "
                            << leaks.compression;
                    }
    }
    this->report("A10_policies",
        "largest relative error of irradiance, every search, kernel, bias and policy:", this->largest_error_);
}

TYPED_TEST_P(estimators, exact_k_finds_flanns_photons_on_every_distribution)
{
    auto& b = this->b();
    EXPECT_TRUE(rc::check("k-th squared distance = FLANN's bit for bit, set = brute force, ties by id", [&] {
        const auto d = *rc::gen::elementOf(
            std::vector<distribution>(std::begin(all_distributions), std::end(all_distributions)));
        const auto resolution
            = *rc::gen::element(uvec3(1, 1, 1), uvec3(20, 1, 20), uvec3(5, 5, 10), uvec3(1, 1, 40), uvec3(7, 3, 2));
        const auto n = *rc::gen::element(0, 1, 2, 7, 40, 700);
        const auto k = *rc::gen::element(1u, 2u, 3u, 8u, 50u, 333u, 5000u);
        const auto radius = *rc::gen::element(1e-4f, 0.03f, 0.2f, 0.7f, 10.0f);
        const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
        const auto visits = *rc::gen::element(1u, 64u, 3072u);
        const auto s = make_oriented(d, static_cast<std::size_t>(n), resolution, 30, seed);
        knn_settings settings{.k = k, .max_radius = radius, .min_radius = 1e-9f};
        settings.bias = bias_kind::paper;
        settings.visits_per_pass = visits;
        settings.ranges_per_pass = visits == 1 ? 2 : 1023;
        const auto what = this->difference(s, this->known(s, false), settings);
        if (!what.empty())
            RC_FAIL(what);

        if (static_cast<uint>(n) >= k) {
            const auto map = sorted_map(b, upload_photons(b, s), s.photons.g);
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
    // 70,000 photons at one place, 20 nearer: of the k = 520 nearest, 500 are the tied ones with the smallest ids.
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
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const std::vector<vec4> points(1, vec4(0.5f, 0.5f, 0.5f, 1.0f));
    const auto e = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), settings);
    glm::dvec3 flux(0);
    uint tied = 0;
    for (uint i = 0; i < 70020; ++i) {
        const bool nearer = i % 3501 == 17;
        if (nearer || tied++ < 500)
            flux += glm::dvec3(set.powers[i]);
    }
    EXPECT_EQ(b.download(e.used)[0].x, 520u);
    const auto irradiance = b.download(e.irradiance)[0];
    EXPECT_EQ(irradiance.w, 0.0625f);
    double largest = 0;
    for (int c = 0; c < 3; ++c) {
        const double expected = flux[c] / (M_PI * 0.0625);
        largest = std::max(largest, std::abs(static_cast<double>(irradiance[c]) / expected - 1));
        EXPECT_NEAR(irradiance[c], expected, 2e-6 * expected);
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
    const auto map = this->known(s, false);
    for (const uint k : {1u, 4u, 13u, 50u})
        for (const auto bias : all_biases) {
            knn_settings settings{.k = k, .max_radius = 2, .min_radius = 1e-3f};
            settings.bias = bias;
            EXPECT_EQ(this->difference(s, map, settings), "") << "k " << k << " bias " << int(bias);
        }
}

TYPED_TEST_P(estimators, squared_distances_too_small_for_a_float_count_as_zero)
{
    // Points that follow each other, so close to a photon that from one to the next its squared distance underflows.
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(0), glm::vec3(1), {3, 3, 3});
    s.photons.positions = {{0.5f, 0, 0, 0}, {1.1e-19f, 0, 0, 0}, {0.25f, 0, 0, 0}, {1.12e-19f, 0, 0, 0}};
    s.photons.powers = {{1, 2, 3, 0}, {5, 7, 11, 0}, {13, 17, 19, 0}, {23, 29, 31, 0}};
    for (int i = 0; i < 20; ++i)
        s.points.emplace_back(static_cast<float>(i) * 5e-21f, 0.0f, 0.0f, 1.0f);
    s.directions.assign(4, vec4(0, -1, 0, 0));
    s.normals.assign(4, vec4(0, 1, 0, 0));
    s.point_normals.assign(20, vec4(0, 1, 0, 0));
    const auto map = this->known(s, false);
    for (const uint k : {1u, 2u, 3u}) {
        knn_settings settings{.k = k, .max_radius = 1, .min_radius = 1e-3f};
        settings.bias = bias_kind::paper;
        EXPECT_EQ(this->difference(s, map, settings), "") << "k " << k;
    }
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
    const auto map = this->known(s, false);
    for (uint k = 1; k <= 300; k += 13) {
        knn_settings settings{.k = k, .max_radius = 2};
        settings.bias = bias_kind::paper;
        EXPECT_EQ(this->difference(s, map, settings), "") << "k " << k;
    }
}

TYPED_TEST_P(estimators, a_photon_on_a_face_is_found_from_any_distance)
{
    // One photon on a face between cells, points on its axis: its distance and the cell that the radius reaches round
    // apart.
    auto& b = this->b();
    for (const int axis : {0, 1, 2})
        for (const int face : {13, 22, 37}) {
            photon_set set;
            uvec3 resolution(1);
            resolution[axis] = 40;
            set.g = make_grid(glm::vec3(0), glm::vec3(1), resolution);
            glm::vec3 p(0.5f);
            p[axis] = static_cast<float>(face) / 40.0f;
            set.positions.emplace_back(p, 0.0f);
            set.powers.emplace_back(1.0f);
            random_source u(static_cast<std::uint64_t>(face));
            std::vector<vec4> points;
            for (int i = 0; i < 5000; ++i) {
                p[axis] = 6 * u() - 3;
                points.emplace_back(p, 1.0f);
            }
            knn_settings k{.k = 1, .max_radius = 10};
            k.bias = bias_kind::paper;
            const auto map = sorted_map(b, upload_photons(b, set), set.g);
            std::size_t lost = 0;
            for (const auto& n : b.download(knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), k).used))
                lost += n.x != 1 ? 1u : 0u;
            EXPECT_EQ(lost, 0u) << "axis " << axis << " face " << face;
        }
}

TYPED_TEST_P(estimators, a_radius_holds_the_photons_on_its_rim)
{
    // Eight photons at the radius itself, to the bit, one just beyond, one inside.
    auto& b = this->b();
    photon_set set;
    set.g = make_grid(glm::vec3(0), glm::vec3(1), {4, 4, 4});
    for (int i = 0; i < 8; ++i)
        set.positions.emplace_back(i < 2 ? 0.5f + (i == 0 ? 0.25f : -0.25f) : 0.5f,
            i >= 2 && i < 4 ? 0.5f + (i == 2 ? 0.25f : -0.25f) : 0.5f,
            i >= 4 ? 0.5f + (i % 2 == 0 ? 0.25f : -0.25f) : 0.5f, 0.0f);
    set.positions.emplace_back(0.75000006f, 0.5f, 0.5f, 0.0f);
    set.positions.emplace_back(0.5f, 0.5f, 0.5f, 0.0f);
    set.powers.assign(10, vec4(1.0f));
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const auto points = b.upload(std::span<const vec4>(std::vector<vec4>(1, {0.5f, 0.5f, 0.5f, 1.0f})));
    for (const auto search : all_searches)
        for (const auto bias : all_biases) {
            knn_settings k{.k = 100, .max_radius = 0.25f};
            k.search = search;
            k.bias = bias;
            const auto e = knn_grid_estimate(b, map, points, k);
            EXPECT_EQ(b.download(e.used)[0].x, 9u) << int(search);
            EXPECT_NEAR(b.download(e.irradiance)[0].x, 9 / (M_PI * 0.0625), 1e-4)
                << int(search); // the radius is given: none is left out
        }
}

TYPED_TEST_P(estimators, no_light_comes_through_a_thin_wall)
{
    // A wall 0.01 thick, lit from above; photons on its upper side and on the floor of a corner beside it.
    auto& b = this->b();
    random_source u(9);
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(0), glm::vec3(1), {10, 10, 10});
    for (int i = 0; i < 2000; ++i) {
        s.photons.positions.emplace_back(u(), 0.51f, u(), 0.0f);
        s.photons.powers.emplace_back(1.0f);
        s.directions.emplace_back(0.0f, -1.0f, 0.0f, 0.0f);
        s.normals.emplace_back(0.0f, 1.0f, 0.0f, 0.0f);
    }
    s.points = {{0.5f, 0.51f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 1.0f}};
    s.point_normals = {{0.0f, 1.0f, 0.0f, 0.0f}, {0.0f, -1.0f, 0.0f, 0.0f}};
    const auto map = sorted_map(b, upload_photons(b, s), s.photons.g);
    const auto points = b.upload(std::span<const vec4>(s.points)),
               normals = b.upload(std::span<const vec4>(s.point_normals));
    double leaked = 0;
    for (const auto search : all_searches) {
        knn_settings k{.k = 50, .max_radius = 0.1f};
        k.search = search;
        const auto leaking = b.download(knn_grid_estimate(b, map, points, normals, k).irradiance);
        EXPECT_GT(leaking[1].x, 0.5f * leaking[0].x);
        for (const leak_policy& leaks :
            {leak_policy{.side = true}, leak_policy{.min_cosine = 0.5f}, leak_policy{.compression = 11}}) {
            k.leaks = leaks;
            const auto e = knn_grid_estimate(b, map, points, normals, k);
            const auto kept = b.download(e.irradiance);
            EXPECT_EQ(kept[0].x, leaking[0].x); // what was right stays
            EXPECT_EQ(kept[1].x, 0.0f);
            EXPECT_EQ(b.download(e.used)[1].x, 0u);
            leaked = std::max(leaked, static_cast<double>(kept[1].x));
        }
    }
    this->report("A10", "irradiance on the dark side of a wall under any policy:", leaked);
}

TYPED_TEST_P(estimators, searches_refuse_what_they_cannot_do)
{
    auto& b = this->b();
    const auto set = make_photons(distribution::uniform, 100, {4, 4, 4}, 1);
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const auto points = b.upload(std::span<const vec4>(make_points(set, 10, 1)));
    knn_settings k{.k = 5, .max_radius = 1};
    k.leaks.side = true;
    EXPECT_THROW(knn_grid_estimate(b, map, points, k), std::invalid_argument);         // no normals of points
    EXPECT_THROW(knn_grid_estimate(b, map, points, points, k), std::invalid_argument); // no directions of photons
    k.leaks = {.min_cosine = 0.5f};
    EXPECT_THROW(knn_grid_estimate(b, map, points, points, k), std::invalid_argument); // no normals of photons
    k.leaks = {.compression = 0.5f};
    EXPECT_THROW(knn_grid_estimate(b, map, points, points, k), std::invalid_argument);
    k.leaks = {.compression = std::numeric_limits<float>::quiet_NaN()};
    EXPECT_THROW(knn_grid_estimate(b, map, points, points, k), std::invalid_argument);
}

TYPED_TEST_P(estimators, searches_can_be_watched_and_resumed)
{
    auto& b = this->b();
    const auto s = make_oriented(distribution::clustered, 4000, {12, 12, 12}, 1200, 2);
    const auto at = b.upload(std::span<const vec4>(s.points));
    const auto map = sorted_map(b, upload_photons(b, s), s.photons.g);
    for (const auto search : all_searches) {
        knn_settings k{.k = 200, .max_radius = 0.3f};
        k.search = search;
        k.errors = true;
        const auto whole = knn_grid_estimate(b, map, at, k);
        k.visits_per_pass = 100; // another budget, the same result
        k.ranges_per_pass = 20;
        knn_search<typename TestFixture::B> watched(b, map, at, k);
        std::size_t passes = 0;
        for (bool finished = false; !finished && passes < 100000; ++passes) {
            const auto p = watched.advance(1);
            ASSERT_LE(p.passes, 1u);
            finished = p.finished;
            const auto now = watched.estimates();
            for (const auto& e : b.download(now.irradiance))
                ASSERT_TRUE(std::isfinite(e.x) && std::isfinite(e.w));
            for (const auto& e : b.download(now.standard_error))
                ASSERT_TRUE(std::isfinite(e.w) && e.w >= 0);
            for (const auto& u : b.download(now.used))
                ASSERT_LE(u.x, 4000u);
        }
        EXPECT_GT(passes, 4u);
        EXPECT_EQ(count_different_bits(b.download(watched.estimates().irradiance), b.download(whole.irradiance)), 0u)
            << int(search);
        EXPECT_EQ(
            count_different_bits(b.download(watched.estimates().standard_error), b.download(whole.standard_error)), 0u);
        EXPECT_EQ(count_different_bits(b.download(watched.estimates().used), b.download(whole.used)), 0u);
        EXPECT_TRUE(watched.advance(5).finished);
    }
}

TYPED_TEST_P(estimators, equal_the_serial_backends_bit_for_bit)
{
    auto& b = this->b();
    serial_backend serial;
    for (const auto d : all_distributions)
        for (const auto resolution : {uvec3(1, 1, 1), uvec3(9, 9, 18)})
            for (const auto search : all_searches) {
                const auto s = make_oriented(d, 3000, resolution, 300, 11);
                const auto run = [&](auto& device) {
                    knn_settings k{.k = 64, .max_radius = 0.25f};
                    k.search = search;
                    k.kernel = filter_kernel::epanechnikov;
                    k.leaks = {.side = true, .compression = 2};
                    k.errors = true;
                    const auto map = sorted_map(device, upload_photons(device, s), s.photons.g);
                    const auto e = knn_grid_estimate(device, map, device.upload(std::span<const vec4>(s.points)),
                        device.upload(std::span<const vec4>(s.point_normals)), k);
                    return std::tuple{
                        device.download(e.irradiance), device.download(e.used), device.download(e.standard_error)};
                };
                const auto [irradiance, used, errors] = run(b);
                const auto [irradiance_s, used_s, errors_s] = run(serial);
                const auto where = std::string(name_of(d)) + " search " + std::to_string(int(search));
                // Which photons: the same everywhere. How many were looked at, and their light, where division rounds
                // correctly.
                for (std::size_t i = 0; i < used.size(); ++i) {
                    ASSERT_EQ(used[i].x, used_s[i].x) << where;
                    ASSERT_EQ(irradiance[i].w, irradiance_s[i].w) << where;
                    const float tolerance = adds_as_serial<TypeParam>() ? 1e-5f : 1e-6f;
                    ASSERT_NEAR(irradiance[i].x, irradiance_s[i].x, tolerance * irradiance_s[i].x) << where;
                    ASSERT_NEAR(errors[i].w, errors_s[i].w, tolerance * errors_s[i].w) << where;
                }
                if (b.caps().exact_division && b.caps().exact_sqrt && adds_as_serial<TypeParam>()) {
                    EXPECT_EQ(count_different_bits(irradiance, irradiance_s), 0u) << where;
                    EXPECT_EQ(count_different_bits(used, used_s), 0u) << where;
                    EXPECT_EQ(count_different_bits(errors, errors_s), 0u) << where;
                }
            }
}

REGISTER_TYPED_TEST_SUITE_P(estimators, every_combination_equals_brute_force,
    exact_k_finds_flanns_photons_on_every_distribution, ties_at_the_kth_distance_go_by_id, ties_in_many_cells_go_by_id,
    squared_distances_too_small_for_a_float_count_as_zero, distances_next_to_each_other_are_told_apart,
    a_photon_on_a_face_is_found_from_any_distance, a_radius_holds_the_photons_on_its_rim,
    no_light_comes_through_a_thin_wall, searches_refuse_what_they_cannot_do, searches_can_be_watched_and_resumed,
    equal_the_serial_backends_bit_for_bit);

} // namespace photongrid::testing
