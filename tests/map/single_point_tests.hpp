// Searches for one point, and their agreement with those for many: limits, radii that are no numbers, searches within
// searches.
#pragma once

#include "host_map_devices.hpp"
#include "host_photons.hpp"

#include <photongrid/photon_map.hpp>
#include <photongrid/point_index.hpp>

#include <limits>

namespace photongrid::testing {

TYPED_TEST(host_maps, every_search_treats_radii_alike)
{
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    const std::vector<glm::vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {nan, 0, 0}};
    const std::vector<glm::vec3> queries{{0, 0, 0}, {0, nan, 0}, {infinite, 0, 0}};
    const point_index index(this->device_, points);
    query_scratch scratch;
    const auto counts_of = [&](float radius) {
        const auto nearest = index.nearest(queries, 9, radius), within = index.within(queries, radius);
        const auto counts = index.count_within(queries, radius);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            EXPECT_EQ(nearest[i].size(), counts[i]);
            EXPECT_EQ(within[i].size(), counts[i]);
            uint single = 0, single_nearest = 0;
            index.for_each_within(queries[i], radius, [&](photon_id, float) { ++single; });
            index.for_each_nearest(queries[i], 9, radius, scratch, [&](photon_id, float) { ++single_nearest; });
            EXPECT_EQ(single, counts[i]);
            EXPECT_EQ(single_nearest, counts[i]);
        }
        return counts;
    };
    using counts = std::vector<uint>;
    EXPECT_EQ(counts_of(infinite), (counts{3, 0, 0}));
    EXPECT_EQ(counts_of(1), (counts{2, 0, 0}));
    EXPECT_EQ(counts_of(0), (counts{0, 0, 0}));
    EXPECT_EQ(counts_of(-1), (counts{0, 0, 0}));

    const auto ignore = [](photon_id, float) {};
    for (const auto& asked : {queries, std::vector<glm::vec3>{}}) {
        EXPECT_THROW(static_cast<void>(index.nearest(asked, 9, nan)), std::invalid_argument);
        EXPECT_THROW(static_cast<void>(index.within(asked, nan)), std::invalid_argument);
        EXPECT_THROW(static_cast<void>(index.count_within(asked, nan)), std::invalid_argument);
    }
    EXPECT_THROW(index.for_each_within(queries[0], nan, ignore), std::invalid_argument);
    EXPECT_THROW(index.for_each_nearest(queries[0], 9, nan, scratch, ignore), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(index.nearest(queries, 0)), std::invalid_argument);
    EXPECT_THROW(index.for_each_nearest(queries[0], 0, scratch, ignore), std::invalid_argument);
    EXPECT_THROW(index.for_each_nearest(queries[0], 0, ignore), std::invalid_argument);
}

/// f may search again where the thread's scratch is used, as clustering does.
TEST(host_map, searches_may_be_nested)
{
    std::vector<glm::vec3> points;
    for (int i = 0; i < 200; ++i)
        points.emplace_back(static_cast<float>(i), 0, 0);
    serial_backend device;
    const point_index index(device, points, 3);
    std::vector<photon_id> outer, inner;
    index.for_each_nearest(points[100], 20, [&](photon_id id, float) {
        outer.push_back(id);
        index.for_each_nearest(points[id], 60, 1.5f, [&](photon_id of, float) { inner.push_back(of); });
    });
    ASSERT_EQ(outer.size(), 20u);
    ASSERT_EQ(inner.size(), 60u); // itself, left, right
    for (std::size_t i = 0; i < outer.size(); ++i) {
        EXPECT_EQ(outer[i], 100u + (i % 2 == 0 ? 1u : ~0u) * static_cast<uint>((i + 1) / 2)) << i;
        EXPECT_EQ(inner[3 * i], outer[i]);
        EXPECT_EQ(inner[3 * i + 1], outer[i] - 1);
        EXPECT_EQ(inner[3 * i + 2], outer[i] + 1);
    }
}

} // namespace photongrid::testing
