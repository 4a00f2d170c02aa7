// photon_map and point_index, as hosts use them: against brute force, FLANN, searches for many points on serial, from
// many threads, and what must not compile.
#include "host_map_devices.hpp"
#include "host_photons.hpp"
#include "no_estimate_tests.hpp"
#include "photon_generator.hpp"
#include "single_point_tests.hpp"
#include "vector_view_tests.hpp"

#include <photongrid/photon_map.hpp>
#include <photongrid/point_index.hpp>
#include <photongrid/render/view_pass.hpp>

#include <flann/flann.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <thread>

namespace photongrid::testing {

/// All searches of a photon_map and a point_index of these photons equal brute force.
inline void equal_brute_force(
    const std::vector<host_photon>& photons, const std::vector<glm::vec3>& points, uint k, float radius)
{
    serial_backend device;
    const photon_map map(device, photons, {.k = k});
    std::vector<glm::vec3> positions;
    auto without_power = photons; // what a point_index holds
    for (auto& p : without_power) {
        positions.push_back(p.position);
        p.power = glm::vec3(1);
    }
    const point_index index(device, positions, k);
    const auto nearest = index.nearest(points, k, radius), within = index.within(points, radius);
    const auto counts = index.count_within(points, radius);
    const auto of_list = [](std::span<const point_neighbour> list) {
        neighbours_of_point all;
        for (const auto& n : list)
            all.emplace_back(n.distance2, n.id);
        return all;
    };
    const auto are_within = [&](neighbours_of_point all) {
        std::erase_if(all, [&](const auto& n) { return !(radius > 0) || !(n.first <= radius * radius); });
        return all;
    };
    const auto first = [&](neighbours_of_point all) {
        all.resize(std::min<std::size_t>(k, all.size()));
        return all;
    };
    query_scratch scratch;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& p = points[i];
        neighbours_of_point found;
        const auto find = [&](photon_id id, float d2) { found.emplace_back(d2, id); };
        const auto expected = by_brute_force(photons, p);
        map.for_each_within(p, radius, find);
        std::sort(found.begin(), found.end());
        RC_ASSERT(found == are_within(expected));
        found.clear();
        map.for_each_nearest(p, k, scratch, find);
        RC_ASSERT(found == first(expected));
        found.clear();
        map.for_each_nearest(p, k, radius, scratch, find);
        RC_ASSERT(found == first(are_within(expected)));

        const auto expected_points = are_within(by_brute_force(without_power, p));
        RC_ASSERT(of_list(within[i]) == expected_points);
        RC_ASSERT(of_list(nearest[i]) == first(expected_points));
        RC_ASSERT(counts[i] == expected_points.size());
    }
}

/// Photons that lose each other as RapidCheck shrinks them.
RC_GTEST_PROP(host_map_properties, searches_equal_brute_force_for_any_distribution, ())
{
    const auto set = make_photons(*any_distribution(), *photon_numbers(500), {5, 5, 5});
    std::vector<host_photon> photons;
    for (std::size_t i = 0; i < set.positions.size(); ++i)
        photons.push_back({glm::vec3(set.positions[i]), glm::vec3(set.powers[i]), -up, up});
    std::vector<glm::vec3> points;
    for (const auto& p : make_points(set, 20, 1))
        points.emplace_back(p);
    equal_brute_force(photons, points, *rc::gen::inRange(1u, 70u), *rc::gen::element(0.03f, 0.3f, 3.0f));
}

/// Photons and points at places that RapidCheck draws and shrinks, NaN, infinity and denormals among them.
RC_GTEST_PROP(host_map_properties, searches_equal_brute_force_for_any_numbers, ())
{
    const auto positions = *rc::gen::resize(200, any_vectors(0)), powers = *rc::gen::resize(10, any_vectors(0)),
               points = *rc::gen::resize(20, any_vectors(1));
    std::vector<host_photon> photons;
    for (std::size_t i = 0; i < positions.size(); ++i)
        photons.push_back(
            {glm::vec3(positions[i]), powers.empty() ? glm::vec3(1) : glm::vec3(powers[i % powers.size()]), -up, up});
    std::vector<glm::vec3> query_points;
    for (const auto& p : points)
        query_points.emplace_back(p);
    equal_brute_force(photons, query_points, *rc::gen::inRange(1u, 40u),
        *rc::gen::element(-1.0f, 0.0f, 1e-30f, 0.125f, 0.7f, 5.0f, 1e20f, std::numeric_limits<float>::infinity()));
}

/// Every filter, bias and policy: the single query has the radius and the photons of the search for many points, to the
/// bit, and its light to rounding.
TYPED_TEST(host_maps, single_queries_equal_a_search_for_many_points)
{
    serial_backend serial;
    query_scratch scratch;
    int cases = 0;
    for (const bool ties : {false, true})
        for (const auto search : {search_kind::exact_k, search_kind::fixed_radius})
            for (const auto& filter : filters)
                for (const auto bias : {bias_kind::paper, bias_kind::unbiased})
                    for (const auto& leaks : {leak_policy{}, leak_policy{.side = true}, leak_policy{.min_cosine = 0.3f},
                             leak_policy{.flattening = 3}})
                        for (const float most : {0.05f, 0.4f}) {
                            const knn_settings s{.k = 20,
                                .max_radius = most,
                                .search = search,
                                .filter = filter.kind,
                                .bias = bias,
                                .leaks = leaks};
                            const auto photons = some_photons(7 + static_cast<uint>(cases++), 800, ties);
                            const auto query_points = some_query_points(7, 40, ties);
                            const std::vector<glm::vec3> normals(query_points.size(), up);
                            const photon_map many(serial, photons, s);
                            const photon_map one(this->device_, photons, s);
                            const auto expected = many.irradiance(query_points, normals, {.standard_error = true});
                            for (std::size_t i = 0; i < query_points.size(); ++i) {
                                const auto e = one.irradiance(query_points[i], up, scratch);
                                ASSERT_EQ(e.radius, expected[i].radius);
                                ASSERT_EQ(e.count, expected[i].count);
                                for (int c = 0; c < 3; ++c) {
                                    ASSERT_NEAR(
                                        e.value[c], expected[i].value[c], 1e-5f * expected[i].value[c] + 1e-12f);
                                    ASSERT_NEAR(
                                        e.error[c], expected[i].error[c], 1e-4f * expected[i].error[c] + 1e-12f);
                                }
                                ASSERT_NEAR(e.error_of_sum, expected[i].error_of_sum,
                                    1e-4f * expected[i].error_of_sum + 1e-12f);
                            }
                        }
    EXPECT_EQ(cases, 2 * 2 * 4 * 2 * 4 * 2);
}

TYPED_TEST(host_maps, many_query_points_give_named_results)
{
    const auto photons = some_photons(3, 5000, false);
    const auto query_points = some_query_points(3, 100, false);
    const photon_map map(this->device_, photons, {.k = 30});
    EXPECT_EQ(map.size(), 5000u);
    const auto plain = map.irradiance(query_points),
               with_error = map.irradiance(query_points, {.standard_error = true});
    ASSERT_EQ(plain.size(), query_points.size());
    for (std::size_t i = 0; i < query_points.size(); ++i) {
        const auto nearest = by_brute_force(photons, query_points[i]);
        EXPECT_EQ(plain[i].count, 30u);
        EXPECT_EQ(plain[i].radius, std::sqrt(nearest[29].first));
        EXPECT_EQ(plain[i].value, with_error[i].value);
        EXPECT_EQ(plain[i].error, glm::vec3(0));
        EXPECT_GT(with_error[i].error.x, 0.0f);
    }
}

TYPED_TEST(host_maps, attributes_that_lie_apart_give_the_same_map)
{
    const auto photons = some_photons(4, 3000, false);
    std::vector<std::array<float, 3>> positions;
    std::vector<glm::vec3> powers, normals;
    for (const auto& p : photons) {
        positions.push_back({p.position.x, p.position.y, p.position.z});
        powers.push_back(p.power);
        normals.push_back(p.normal);
    }
    const auto query_points = some_query_points(4, 50, false);
    const photon_map whole(this->device_, photons, {.k = 20});
    const photon_map apart(this->device_, {.positions = positions, .powers = powers, .normals = normals}, {.k = 20});
    const auto a = whole.irradiance(query_points), b = apart.irradiance(query_points);
    for (std::size_t i = 0; i < query_points.size(); ++i) {
        EXPECT_EQ(a[i].value, b[i].value);
        EXPECT_EQ(a[i].radius, b[i].radius);
    }
    try {
        photon_map(this->device_, {.positions = positions});
        FAIL() << "photons without power";
    } catch (const std::invalid_argument& e) {
        EXPECT_STREQ(e.what(), "photon_map: powers: 0 elements for 3000 photons; each needs one");
    }
}

/// Single queries from eight threads on one map, while this thread searches for many points on its device.
TYPED_TEST(host_maps, any_thread_may_ask)
{
    const auto photons = some_photons(5, 20000, false);
    const auto query_points = some_query_points(5, 400, false);
    const photon_map map(this->device_, photons, {.k = 50});
    std::vector<irradiance_at_point> expected;
    query_scratch scratch;
    for (const auto& p : query_points)
        expected.push_back(map.irradiance(p, up, scratch));
    std::atomic<int> wrong = 0;
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 8; ++t)
            threads.emplace_back([&, t] {
                query_scratch mine;
                for (std::size_t i = 0; i < query_points.size(); ++i) {
                    const auto at = (i + static_cast<std::size_t>(t) * 50) % query_points.size();
                    const auto e = map.irradiance(query_points[at], up, mine);
                    uint within = 0;
                    map.for_each_within(query_points[at], e.radius, [&](photon_id, float) { ++within; });
                    wrong += e.value != expected[at].value || within + 1 < e.count ? 1 : 0;
                }
            });
        for (int round = 0; round < 3; ++round)
            EXPECT_EQ(map.irradiance(query_points).size(), query_points.size());
    }
    EXPECT_EQ(wrong, 0);
}

TYPED_TEST(host_maps, points_that_are_not_light_agree_with_flann)
{
    const auto photons = some_photons(6, 4000, false);
    std::vector<glm::vec3> points;
    for (const auto& p : photons)
        points.push_back(p.position);
    auto query_points = some_query_points(6, 100, false);
    const point_index index(this->device_, points);
    constexpr uint k = 12;
    const auto nearest = index.nearest(query_points, k);

    flann::Matrix<float> data(&points[0].x, points.size(), 3), queries(&query_points[0].x, query_points.size(), 3);
    flann::Index<flann::L2<float>> tree(data, flann::KDTreeSingleIndexParams());
    tree.buildIndex();
    std::vector<std::vector<int>> ids;
    std::vector<std::vector<float>> distances2;
    tree.knnSearch(queries, ids, distances2, k, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    constexpr float radius = 0.2f;
    const auto counts = index.count_within(query_points, radius);
    const auto within = index.within(query_points, radius);
    for (std::size_t i = 0; i < query_points.size(); ++i) {
        ASSERT_EQ(nearest[i].size(), k);
        for (std::size_t j = 0; j < k; ++j)
            EXPECT_FLOAT_EQ(nearest[i][j].distance2, distances2[i][j]);
        const auto all = by_brute_force(photons, query_points[i]);
        const auto expected
            = std::count_if(all.begin(), all.end(), [](const auto& e) { return e.first <= radius * radius; });
        EXPECT_EQ(counts[i], static_cast<uint>(expected));
        ASSERT_EQ(within[i].size(), static_cast<std::size_t>(expected));
        for (std::size_t j = 0; j < within[i].size(); ++j)
            EXPECT_EQ(within[i][j], (point_neighbour{all[j].second, all[j].first}));
    }
}

TEST(host_map, nothing_is_found_in_nothing)
{
    serial_backend device;
    const std::vector<host_photon> none;
    const photon_map map(device, none, {.k = 3});
    query_scratch scratch;
    const auto e = map.irradiance(glm::vec3(0), up, scratch);
    EXPECT_EQ(e.count, 0u);
    EXPECT_EQ(e.value, glm::vec3(0));
    const auto not_a_number = std::numeric_limits<float>::quiet_NaN();
    map.for_each_within(glm::vec3(not_a_number), 1, [](photon_id, float) { FAIL(); });
    EXPECT_TRUE(map.irradiance(std::vector<glm::vec3>{}).empty());
}

/// Without a bound no disc holds more photons than there are: an estimate would be black.
TEST(host_map, more_photons_than_there_are_need_a_radius)
{
    serial_backend device;
    const auto photons = some_photons(1, 100, false);
    const std::vector<glm::vec3> points{{0.5f, 0.5f, 0}};
    query_scratch scratch;
    for (const auto search : {search_kind::exact_k, search_kind::at_least_k}) {
        const photon_map map(device, photons, {.k = 101, .search = search});
        EXPECT_THROW(static_cast<void>(map.irradiance(points)), std::invalid_argument);
    }
    const photon_map map(device, photons, {.k = 101});
    EXPECT_THROW(static_cast<void>(map.irradiance(points[0], up, scratch)), std::invalid_argument);
    int found = 0;
    map.for_each_nearest(points[0], 101, [&](photon_id, float) { ++found; });
    EXPECT_EQ(found, 100);
    EXPECT_EQ(photon_map(device, photons, {.k = 100}).irradiance(points)[0].count, 100u);
    EXPECT_EQ(photon_map(device, photons, {.k = 101, .max_radius = 100}).irradiance(points)[0].count, 100u);
}

TEST(host_map, the_growing_search_is_for_many_points)
{
    serial_backend device;
    const photon_map map(device, some_photons(1, 100, false), as_paper({.k = 3}));
    EXPECT_EQ(map.irradiance(std::vector<glm::vec3>{{1, 0.5f, 0.1f}}).size(), 1u);
    query_scratch scratch;
    EXPECT_THROW(static_cast<void>(map.irradiance(glm::vec3(0), up, scratch)), std::invalid_argument);
}

// What would refer to something that is gone does not compile.
using device = serial_backend;
using photon_list = std::vector<host_photon>;
template <class Device, class Photons>
concept makes_map = requires(Device&& d, Photons&& p)
{
    photon_map<device>(std::forward<Device>(d), std::forward<Photons>(p));
};
static_assert(makes_map<device&, photon_list&> && makes_map<device&, photon_list>); // photons are copied
static_assert(!makes_map<device, photon_list&>);
template <class Map>
concept gives_buffers = requires(Map&& m)
{
    std::forward<Map>(m).buffers();
};
static_assert(gives_buffers<photon_map<device>&> && !gives_buffers<photon_map<device>>);
template <class Lists>
concept gives_list = requires(Lists&& l)
{
    std::forward<Lists>(l)[0];
};
static_assert(gives_list<point_neighbours&> && !gives_list<point_neighbours>);
template <class Search, class Map, class Points>
concept searches = requires(device& d, Map&& m, Points&& p)
{
    Search(d, std::forward<Map>(m), std::forward<Points>(p), knn_settings{});
};
using buffers = map_buffers<device>;
using vectors = buffer_of<device, glm::vec4>;
static_assert(searches<knn_search<device>, buffers&, vectors&>);
static_assert(!searches<knn_search<device>, buffers, vectors&> && !searches<knn_search<device>, buffers&, vectors>);
using vec3_list = std::vector<glm::vec3>;
template <class Vectors>
concept attributes = requires(Vectors&& v)
{
    photon_attributes{.positions = std::forward<Vectors>(v)};
};
static_assert(attributes<vec3_list&> && attributes<const vec3_list&> && attributes<std::span<const glm::vec3>>);
static_assert(!attributes<vec3_list> && !attributes<const vec3_list>);
static_assert(
    !std::is_constructible_v<vector_view, vec3_list> && !std::is_constructible_v<vector_view, const vec3_list>);
static_assert(std::is_convertible_v<vec3_list, vector_argument>); // a parameter need not keep
template <class Scene>
constexpr bool traces = std::is_constructible_v<photon_tracing<device>, device&, Scene, const render_settings&>;
static_assert(traces<device_scene<device>&> && traces<const device_scene<device>&>);
static_assert(!traces<device_scene<device>> && !traces<const device_scene<device>>);
template <class Map>
constexpr bool views = std::is_constructible_v<view_pass<device>, device&, Map, const camera&, const render_settings&,
    const view_pass_settings&, render_stats&>;
static_assert(views<built_map<device>&> && views<const built_map<device>&>);
static_assert(!views<built_map<device>> && !views<const built_map<device>>);

} // namespace photongrid::testing
