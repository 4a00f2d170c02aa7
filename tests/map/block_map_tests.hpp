// The block map: its order, its boxes, its searches' answers on photons that no grid suits, on any backend.
#pragma once

#include "algorithms.hpp"

#include <photongrid/map/map_builders.hpp>

namespace photongrid::testing {

/// Photons of which a grid's cells hold all or none: clusters far smaller than their distances, one in another, strays.
/// `tied`: one photon in eleven is at the same place.
inline photon_set hard_photons(std::size_t n, std::uint64_t seed, bool tied)
{
    random_source u(seed);
    photon_set s;
    s.g = make_grid(glm::vec3(-1), glm::vec3(1), {4, 4, 4});
    for (std::size_t i = 0; i < n; ++i) {
        const float size = std::ldexp(1.0f, -4 * static_cast<int>(u.below(12)));
        const glm::vec3 center = u.below(3) == 0 ? glm::vec3(0.3f, -0.2f, 0.7f) : glm::vec3(0);
        glm::vec3 p = center + size * (2.0f * glm::vec3(u(), u(), u()) - 1.0f);
        if (i % 97 == 5)
            p = 1e6f * p;
        if (tied && i % 11 == 3)
            p = glm::vec3(0.3f, -0.2f, 0.7f);
        s.positions.emplace_back(p, i % 5 == 0 ? 1.0f : 0.0f);
        s.powers.emplace_back(u(), u(), u(), 0.0f);
    }
    return s;
}

/// `points` near photons, as near as the next ones are, and around all of them.
inline std::vector<vec4> hard_points(const photon_set& s, std::size_t n, std::uint64_t seed)
{
    random_source u(seed ^ 0x1234);
    std::vector<vec4> points;
    for (std::size_t i = 0; i < n; ++i) {
        const auto& p = s.positions[u.below(static_cast<std::uint32_t>(s.positions.size()))];
        const float size = std::ldexp(1.0f, -4 * static_cast<int>(u.below(12)));
        points.emplace_back(glm::vec3(p) + (i % 2 == 0 ? 0.0f : size) * (2.0f * glm::vec3(u(), u(), u()) - 1.0f), 1.0f);
    }
    return points;
}

TEST(the_curve, visits_every_cube_once_and_steps_to_a_neighbour)
{
    constexpr uint side = 16;
    std::map<uint, glm::ivec3> at;
    for (uint x = 0; x < side; ++x)
        for (uint y = 0; y < side; ++y)
            for (uint z = 0; z < side; ++z) {
                const auto along = kernels::curve_word(x << 6, y << 6, z << 6, 0);
                at[along.x >> 18] = {x, y, z};
            }
    ASSERT_EQ(at.size(), side * side * side);
    ASSERT_EQ(at.rbegin()->first, side * side * side - 1);
    for (uint i = 1; i < at.size(); ++i) {
        const auto step = glm::abs(at[i] - at[i - 1]);
        ASSERT_EQ(step.x + step.y + step.z, 1) << "step " << i;
    }
}

TEST(the_curve, goes_on_where_a_word_ends)
{
    // Twenty levels in two words: the last cube of a word's range is next to the first one of the following range.
    std::map<std::pair<uint, uint>, glm::ivec3> at;
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 4; ++y)
            for (int z = 0; z < 4; ++z) {
                const glm::ivec3 cube = glm::ivec3(1022, 1022, 1022) + glm::ivec3(x, y, z); // around a corner of words
                const auto first = kernels::curve_word(
                    static_cast<uint>(cube.x) >> 1, static_cast<uint>(cube.y) >> 1, static_cast<uint>(cube.z) >> 1, 0);
                const auto second = kernels::curve_word(static_cast<uint>(cube.x & 1) << 9,
                    static_cast<uint>(cube.y & 1) << 9, static_cast<uint>(cube.z & 1) << 9, first.y);
                at[{first.x, second.x >> 27}] = cube;
            }
    ASSERT_EQ(at.size(), 64u);
    for (auto a = at.begin(), b = std::next(a); b != at.end(); ++a, ++b)
        if (a->first.first == b->first.first || (a->first.first + 1 == b->first.first && a->first.second == 7)) {
            const auto step = glm::abs(b->second - a->second);
            ASSERT_EQ(step.x + step.y + step.z, 1);
        }
}

TYPED_TEST_P(algorithms, blocks_hold_every_photon_once_in_boxes_that_fit)
{
    auto& b = this->b();
    EXPECT_TRUE(rc::check("ids once, ties by id, boxes tight, for any photons", [&] {
        photon_set s;
        s.positions = *rc::gen::resize(400, any_vectors(0));
        const bool repeat = *rc::gen::arbitrary<bool>(); // so that there are several levels
        for (uint copies = repeat ? 20 : 0; copies > 0; --copies)
            s.positions.insert(s.positions.end(), s.positions.begin(),
                s.positions.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(s.positions.size(), 20)));
        for (std::size_t i = 0; i < s.positions.size(); ++i) {
            s.powers.emplace_back(i % 13 == 12 ? std::numeric_limits<float>::quiet_NaN() : 1.0f, 1.0f, 1.0f, 0.0f);
            s.positions[i].w = i % 3 == 0 ? 1.0f : 0.0f;
        }
        const uint parts = *rc::gen::element(every_part, other_part, caustic_part);
        const auto map = block_map(b, upload_photons(b, s), parts);
        std::set<uint> expected, found;
        for (uint id = 0; id < s.positions.size(); ++id)
            if (is_finite(s.positions[id]) && is_finite(s.powers[id])
                && (parts & (s.positions[id].w == 1.0f ? caustic_part : other_part)) != 0)
                expected.insert(id);
        RC_ASSERT(map.in_blocks == expected.size());
        const auto list = b.download(map.list);
        const auto positions = b.download(map.photons.positions);
        const auto corners = b.download(map.boxes);
        for (uint i = 0; i < map.in_blocks; ++i) {
            found.insert(list[i]);
            RC_ASSERT(glm::vec3(positions[i]) == glm::vec3(s.positions[list[i]]));
            if (i > 0 && glm::vec3(positions[i]) == glm::vec3(positions[i - 1]))
                RC_ASSERT(list[i] > list[i - 1]);
        }
        RC_ASSERT(found == expected);
        // Every level's boxes are those of their photons.
        std::uint64_t held = 16;
        for (uint level = map.levels; level-- > 0; held *= 16)
            for (std::uint64_t first = 0; first < map.in_blocks; first += held) {
                glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
                for (std::uint64_t i = first; i < std::min<std::uint64_t>(first + held, map.in_blocks); ++i) {
                    low = glm::min(low, glm::vec3(positions[i]));
                    high = glm::max(high, glm::vec3(positions[i]));
                }
                const uint node = kernels::first_of_level(level) + static_cast<uint>(first / held);
                // A stray at the limit of floats is outside the box of nothing. Denormals count as 0.
                const auto fits = [](const vec4& corner, const glm::vec3& expected) {
                    return glm::all(glm::lessThanEqual(
                        glm::abs(glm::vec3(corner) - expected), glm::vec3(std::numeric_limits<float>::min())));
                };
                RC_ASSERT(fits(corners[kernels::low_corner(node)], glm::min(low, glm::vec3(3e38f))));
                RC_ASSERT(fits(corners[kernels::high_corner(node)], glm::max(high, glm::vec3(-3e38f))));
            }
    }));
}

TYPED_TEST_P(algorithms, block_maps_equal_the_serial_backends)
{
    auto& b = this->b();
    serial_backend serial;
    for (const std::size_t n : {0u, 1u, 16u, 17u, 256u, 257u, 5000u})
        for (const bool hard : {false, true}) {
            const auto s = hard ? hard_photons(n, 3, true) : make_photons(distribution::box_faces, n, {4, 4, 4}, 3);
            const auto map = block_map(b, upload_photons(b, s)), same = block_map(serial, upload_photons(serial, s));
            const auto where = std::to_string(n) + (hard ? " hard photons" : " photons on a box");
            EXPECT_EQ(map.words, same.words) << where;
            EXPECT_EQ(map.levels, same.levels) << where;
            EXPECT_EQ(map.in_blocks, n) << where;
            EXPECT_EQ(b.download(map.list), serial.download(same.list)) << where;
            EXPECT_EQ(count_different_bits(b.download(map.boxes), serial.download(same.boxes)), 0u) << where;
            EXPECT_EQ(count_different_bits(b.download(map.photons.powers), serial.download(same.photons.powers)), 0u)
                << where;
        }
}

TYPED_TEST_P(algorithms, searches_in_blocks_are_exact_at_every_scale)
{
    auto& b = this->b();
    for (const bool tied : {true, false}) {
        const auto s = hard_photons(10000, 8, tied);
        const auto points = hard_points(s, 300, 8);
        const auto map = block_map(b, upload_photons(b, s));
        const auto at = b.upload(std::span<const vec4>(points));
        for (const uint k : {1u, 10u, 200u}) {
            const auto e = knn_grid_estimate(b, map, at, {.k = k});
            const auto irradiance = b.download(e.irradiance);
            const auto used = b.download(e.used);
            double visited = 0;
            for (std::size_t q = 0; q < points.size(); ++q) {
                std::vector<float> near;
                for (const auto& p : s.positions)
                    near.push_back(distance2(points[q], p));
                std::nth_element(near.begin(), near.begin() + k - 1, near.end());
                ASSERT_EQ(irradiance[q].w, near[k - 1]) << "k " << k << " point " << q;
                ASSERT_EQ(used[q].x, k);
                visited += used[q].y;
            }
            // A grid has most photons in few cells, and every scan visits them all.
            if (!tied && k <= 10) {
                EXPECT_LT(visited / static_cast<double>(points.size()), 0.25 * static_cast<double>(s.positions.size()))
                    << "k " << k;
            }
        }
    }
}

TYPED_TEST_P(algorithms, fitted_maps_are_of_the_kind_that_suits_the_photons)
{
    auto& b = this->b();
    auto in_clusters = hard_photons(10000, 9, false);
    for (const uint k : {1u, 10u, 100u}) {
        EXPECT_TRUE(fitted_map(b, upload_photons(b, in_clusters), k).has_blocks()) << "k " << k;
        const auto evenly
            = fitted_map(b, upload_photons(b, make_photons(distribution::uniform, 10000, {8, 8, 8}, 9)), k);
        EXPECT_EQ(evenly.has_blocks(), k == 1 && b.caps().prefers_blocks) << "k " << k;
    }
    // Photons of a cluster and others by turns: a sample at equal intervals would see the others alone.
    auto by_turns = make_photons(distribution::uniform, 65536, {8, 8, 8}, 9);
    for (std::size_t i = 1; i < by_turns.positions.size(); i += 2)
        by_turns.positions[i] = vec4(0.5f + 1e-4f * glm::vec3(by_turns.positions[i]), 0.0f);
    EXPECT_TRUE(fitted_map(b, upload_photons(b, by_turns), 10).has_blocks());
    // As large a part of the photons as other builders take.
    const auto caustic = fitted_map(b, upload_photons(b, in_clusters), 10, caustic_part);
    EXPECT_EQ(caustic.in_blocks, 2000u);
    EXPECT_EQ(caustic.left_out, 8000u);
}

} // namespace photongrid::testing
