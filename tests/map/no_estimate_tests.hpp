// Where a photon_map has no estimate, callers can see it.
#pragma once

#include "host_map_devices.hpp"
#include "host_photons.hpp"

#include <photongrid/photon_map.hpp>

#include <limits>

namespace photongrid::testing {

/// 100 photons of which three arrive from above, so that leak_policy::side leaves three.
inline std::vector<host_photon> mostly_from_below()
{
    auto photons = some_photons(11, 100, false);
    for (std::size_t i = 0; i < photons.size(); ++i)
        photons[i].direction = i % 40 == 7 ? -up : up;
    for (auto& p : photons)
        p.power = {1, 2, 3};
    return photons;
}

inline void expect_none(const irradiance_at_point& e, uint found)
{
    EXPECT_FALSE(e.is_estimate());
    EXPECT_EQ(e.radius, std::numeric_limits<float>::infinity());
    EXPECT_EQ(e.value, glm::vec3(0));
    EXPECT_EQ(e.error, glm::vec3(0));
    EXPECT_EQ(e.error_of_sum, 0.0f);
    EXPECT_EQ(e.count, found);
}

TYPED_TEST(host_maps, too_few_photons_without_a_bound_are_no_estimate)
{
    const std::vector<glm::vec3> points{{1, 0.5f, 0.1f}, {30, 0, 0}}, normals(2, up);
    query_scratch scratch;
    for (const auto search : {search_kind::exact_k, search_kind::at_least_k})
        for (const auto bias : {bias_kind::unbiased, bias_kind::paper})
            for (const uint k : {3u, 4u}) {
                const photon_map map(this->device_, mostly_from_below(),
                    {.k = k, .search = search, .bias = bias, .leaks = {.side = true}});
                const auto found = map.irradiance(points, normals, {.standard_error = true});
                for (std::size_t i = 0; i < points.size(); ++i) {
                    if (k == 3) {
                        EXPECT_TRUE(found[i].is_estimate());
                        EXPECT_GT(found[i].value.x, 0.0f);
                    } else
                        expect_none(found[i], 3);
                    if (search != search_kind::exact_k)
                        continue; // single points have no other search
                    const auto one = map.irradiance(points[i], up, scratch);
                    EXPECT_EQ(one.radius, found[i].radius);
                    if (k == 4)
                        expect_none(one, 3);
                }
            }
}

/// Within a bound, the power of few photons is that of the whole disc.
TYPED_TEST(host_maps, too_few_photons_within_a_bound_are_an_estimate)
{
    const std::vector<glm::vec3> points{{1, 0.5f, 0.1f}, {90, 0, 0}}, normals(2, up);
    query_scratch scratch;
    for (const auto search : {search_kind::exact_k, search_kind::fixed_radius}) {
        const photon_map map(
            this->device_, mostly_from_below(), {.k = 4, .max_radius = 4, .search = search, .leaks = {.side = true}});
        const auto found = map.irradiance(points, normals);
        const float expected = 3 / (3.14159265f * 16);
        for (const auto& e : {found[0], map.irradiance(points[0], up, scratch)}) {
            EXPECT_TRUE(e.is_estimate());
            EXPECT_EQ(e.count, 3u);
            EXPECT_NEAR(e.value.x, expected, 1e-5f * expected);
        }
        for (const auto& e : {found[1], map.irradiance(points[1], up, scratch)}) { // darkness
            EXPECT_TRUE(e.is_estimate());
            EXPECT_EQ(e.count, 0u);
            EXPECT_EQ(e.value, glm::vec3(0));
            EXPECT_EQ(e.radius, 4.0f);
        }
    }
}

TYPED_TEST(host_maps, points_that_are_not_finite_have_no_estimate)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), most = std::numeric_limits<double>::max();
    const std::vector<glm::dvec3> points{{nan, 0, 0}, {0, -std::numeric_limits<double>::infinity(), 0}, {0, 0, most}};
    query_scratch scratch;
    for (const auto& settings : {knn_settings{.k = 5}, knn_settings{.k = 5, .max_radius = 0.3f},
             knn_settings{.max_radius = 0.3f, .search = search_kind::fixed_radius}}) {
        const photon_map map(this->device_, some_photons(12, 200, false), settings);
        const auto found = map.irradiance(points, {.standard_error = true});
        for (std::size_t i = 0; i < points.size(); ++i) {
            expect_none(found[i], 0);
            expect_none(map.irradiance(points[i], up, scratch), 0);
        }
    }
}

/// Standard errors are asked for in one way.
TEST(host_map, errors_are_not_a_setting)
{
    serial_backend device;
    EXPECT_THROW((photon_map(device, some_photons(1, 100, false), {.k = 5, .errors = true})), std::invalid_argument);
}

} // namespace photongrid::testing
