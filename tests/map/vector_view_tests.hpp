// Views of a host's vectors: layouts, precision, and what is no vector.
#pragma once

#include "host_map_devices.hpp"
#include "host_photons.hpp"

#include <photongrid/photon_map.hpp>
#include <photongrid/point_index.hpp>

#include <array>
#include <limits>
#include <span>

namespace photongrid::testing {

struct surveyed {
    double x, y, z;
};

/// The ids of the k nearest, in ascending order.
template <class Index, class V>
std::vector<photon_id> nearest_ids(const Index& index, const V& point, uint k)
{
    std::vector<photon_id> ids;
    index.for_each_nearest(point, k, [&](photon_id id, float) { ids.push_back(id); });
    std::sort(ids.begin(), ids.end());
    return ids;
}

/// Points every 0.1 m along a line, as far from 0 as UTM's coordinates are.
TYPED_TEST(host_maps, doubles_far_from_zero_are_told_apart)
{
    std::vector<surveyed> points;
    for (int i = 0; i < 1000; ++i)
        points.push_back({500000 + 0.1 * i, 5400000.0, 310});
    const std::vector<surveyed> query_points{points[436], points[3]};
    // The second time with strays, such as scanners write where they saw nothing.
    for (const int strays : {0, 3}) {
        if (strays > 0)
            points.insert(points.end(), {{0, 0, 0}, {-1e9, 1e9, 1e12}, {0, 0, 0}});
        const point_index index(this->device_, points, 5);
        EXPECT_EQ(index.origin().y, 5400000.0);
        const auto nearest = index.nearest(query_points, 5);
        ASSERT_EQ(nearest.size(), 2u);
        EXPECT_EQ(nearest[0][0], (point_neighbour{436, 0}));
        for (std::size_t i = 1; i < 5; ++i) {
            EXPECT_NEAR(std::sqrt(nearest[0][i].distance2), 0.1 * static_cast<double>((i + 1) / 2), 1e-4);
            EXPECT_LE(std::abs(static_cast<int>(nearest[0][i].id) - 436), 2);
        }
        EXPECT_EQ(nearest_ids(index, query_points[1], 3), (std::vector<photon_id>{2, 3, 4}));
    }
}

/// The origin comes from a sample of every other point; none of these is finite.
TEST(host_map, an_origin_is_found_among_points_that_are_not_finite)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<surveyed> points;
    for (int i = 0; i < 10000; ++i)
        points.push_back({500000 + 0.1 * i, i % 2 == 0 ? nan : 5400000.0, 310});
    serial_backend device;
    const point_index index(device, points, 5);
    EXPECT_EQ(nearest_ids(index, points[4001], 3), (std::vector<photon_id>{3999, 4001, 4003}));
    const point_index none(device, std::vector<surveyed>(10, {nan, nan, nan}));
    EXPECT_EQ(none.origin(), glm::dvec3(0));
}

/// Whole numbers of millimetres have more digits than floats, too.
TEST(host_map, whole_numbers_far_from_zero_are_told_apart)
{
    std::vector<std::array<int, 3>> points;
    for (int i = 0; i < 100; ++i)
        points.push_back({500'000'000 + 7 * i, 540'000'000, 310'000});
    serial_backend device;
    const point_index index(device, points, 3);
    const auto nearest = index.nearest(points, 2);
    EXPECT_EQ(nearest[50][0], (point_neighbour{50, 0}));
    EXPECT_EQ(nearest[50][1], (point_neighbour{49, 49}));
}

/// x, y, z, x, y, z, ...
TYPED_TEST(host_maps, flat_arrays_are_read_by_threes)
{
    const std::vector<float> numbers{0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0, 7};
    const point_index index(this->device_, vector_view::flat(numbers));
    EXPECT_EQ(index.size(), 4u);
    const auto nearest = index.nearest(vector_view::flat(std::span(numbers)), 4);
    const std::vector<float> distances2{0, 1, 9, 49};
    for (uint i = 0; i < 4; ++i)
        EXPECT_EQ(nearest[0][i], (point_neighbour{i, distances2[i]}));
    const std::vector<double> doubles{5e5, 5.4e6, 310, 5e5, 5.4e6 + 0.25, 310};
    EXPECT_TRUE(vector_view::flat(doubles).has_doubles());
    EXPECT_EQ(vector_view::flat(doubles)[1], glm::dvec3(5e5, 5.4e6 + 0.25, 310));
    EXPECT_THROW(static_cast<void>(vector_view::flat(std::span(numbers).first(11))), std::invalid_argument);
    EXPECT_TRUE(vector_view::flat(std::span(numbers).first(0)).empty());

    // One number per photon is a power.
    const std::vector<float> watts{1, 2, 3, 4};
    const photon_map map(this->device_, {.positions = vector_view::flat(numbers), .powers = watts}, {.k = 1});
    const auto powers = this->device_.download(map.buffers().photons.powers);
    const auto list = this->device_.download(map.buffers().list);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(glm::vec3(powers[i]), glm::vec3(watts[list[i]]));
}

/// More elements than ids. Nothing is read before their number is.
TEST(host_map, more_than_a_map_can_hold_is_refused)
{
    serial_backend device;
    const glm::vec3 one(1);
    const vector_view many(
        &one, std::size_t{1} << 32, [](const glm::vec3& v) -> const auto& { return v; });
    EXPECT_THROW((point_index(device, many)), std::invalid_argument);
    EXPECT_THROW((photon_map(device, {.positions = many, .powers = many})), std::invalid_argument);
}

// Numbers are no vectors, neither are pairs.
using numbers = std::vector<float>;
template <class Vectors>
concept positions = requires(Vectors&& v)
{
    photon_attributes{.positions = std::forward<Vectors>(v)};
};
template <class Vectors>
concept powers = requires(Vectors&& v)
{
    photon_attributes{.powers = std::forward<Vectors>(v)};
};
template <class Vectors>
concept directions = requires(Vectors&& v)
{
    photon_attributes{.directions = std::forward<Vectors>(v), .normals = std::forward<Vectors>(v)};
};
static_assert(positions<std::vector<glm::vec3>&> && !positions<numbers&> && !positions<std::span<const double>>);
static_assert(directions<std::vector<glm::vec3>&> && !directions<numbers&>);
static_assert(powers<std::vector<glm::vec3>&> && powers<numbers&> && powers<std::span<const double>>);
static_assert(!powers<numbers>); // it would dangle
static_assert(!std::is_constructible_v<vector_view, numbers&> && !std::is_constructible_v<vector_argument, numbers&>);
static_assert(!std::is_convertible_v<power_view, vector_view>);
static_assert(!std::is_constructible_v<vector_view, const float*, std::size_t, float (*)(const float&)>);
template <class Points>
concept makes_index = requires(serial_backend& d, const Points& p)
{
    point_index<serial_backend>(d, p);
};
static_assert(makes_index<std::vector<glm::vec3>> && makes_index<vector_view> && makes_index<std::vector<glm::vec4>>);
static_assert(!makes_index<numbers> && !makes_index<std::vector<double>> && !makes_index<std::vector<int>>);
static_assert(makes_index<std::vector<std::array<float, 3>>> && !makes_index<std::vector<std::array<float, 2>>>);
static_assert(!makes_index<std::vector<glm::dvec2>> && !makes_index<std::vector<std::span<float, 2>>>);
template <class Points>
concept has_irradiance = requires(const photon_map<serial_backend>& m, const Points& p)
{
    m.irradiance(p);
};
static_assert(has_irradiance<std::vector<glm::vec3>> && !has_irradiance<numbers>);
template <class Numbers>
concept flat = requires(Numbers&& n)
{
    vector_view::flat(std::forward<Numbers>(n));
};
static_assert(flat<numbers&> && flat<const numbers&> && flat<std::span<const float>>);
static_assert(!flat<numbers> && !flat<std::vector<glm::vec3>&>);

} // namespace photongrid::testing
