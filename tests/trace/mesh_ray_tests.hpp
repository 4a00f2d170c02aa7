// Rays against triangles in a tree, on any backend: bit for bit the hits of a loop over all triangles, and about those
// of double precision. Included by each on_<backend>.cpp.
#pragma once

#include "../core/under_test.hpp"
#include "mesh_sets.hpp"

#include <photongrid/trace/ray_search.hpp>
#include <photongrid/trace/ray_tests.kernel.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace photongrid::testing {

/// The closest hit by a test of each triangle.
inline ray_hit hit_by_all(const mesh& m, const glm::vec4& o, const glm::vec4& d)
{
    ray_hit hit{o.w, no_id};
    const auto r = kernels::ray_of(glm::vec3(o), glm::vec3(d));
    for (std::size_t i = 0; i < m.triangles.size(); ++i) {
        const auto t = corners_of(m, i);
        const float at = kernels::hit_triangle(t[0], t[1], t[2], r);
        if (at >= std::numeric_limits<float>::min()
            && (at < hit.distance || (at == hit.distance && hit.triangle == no_id))
            && !kernels::is_behind(detail::plane_of(t), t[0], t[1], t[2], r))
            hit = {at, static_cast<uint>(i)};
    }
    return hit;
}

/// The closest hit in double precision, by Cramer's rule; none if a triangle's edge is too near to say.
inline std::optional<double> distance_in_double(const mesh& m, const glm::vec4& o, const glm::vec4& d)
{
    double closest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < m.triangles.size(); ++i) {
        const auto t = corners_of(m, i);
        const glm::dvec3 a = glm::dvec3(t[0]) - glm::dvec3(glm::vec3(o)), e = glm::dvec3(t[1]) - glm::dvec3(t[0]),
                         f = glm::dvec3(t[2]) - glm::dvec3(t[0]), dir{glm::vec3(d)};
        const glm::dvec3 n = glm::cross(e, f);
        const double slope = glm::dot(n, dir), area = glm::length(n);
        if (area == 0)
            continue;
        const glm::dvec3 c = glm::cross(a, dir);
        // Weights of the corners; their sum is 1.
        const double v = glm::dot(f, c) / slope, w = -glm::dot(e, c) / slope, least = std::min({v, w, 1 - v - w});
        // How much rounding of coordinates may move them.
        const double size = std::max({glm::length(a), glm::length(a + e), glm::length(a + f)}),
                     margin = 4e-7 * size * glm::length(dir) * (glm::length(e) + glm::length(f)) / std::abs(slope);
        if (!(std::abs(least) > margin))
            return std::nullopt;
        if (least > 0 && glm::dot(n, a) / slope > 0)
            closest = std::min(closest, glm::dot(n, a) / slope);
    }
    return closest;
}

template <class Tag>
class mesh_rays : public on_backend<Tag> {
protected:
    std::vector<ray_hit> traced(const mesh& m, const ray_set& rays, const ray_search_settings& s = {})
    {
        auto& b = this->b();
        const auto tree = upload_triangles(b, build_triangle_tree(m));
        return trace_rays(b, tree, upload(b, rays.origins), upload(b, rays.directions), s);
    }
    /// From inside of the closed meshes, `n` rays of each and for each of so many seeds.
    void expect_no_escape(std::size_t n, std::uint32_t seeds)
    {
        for (const auto& [name, m, closed] : ray_meshes(2000))
            for (std::uint32_t seed = 0; closed && seed < seeds; ++seed) {
                const auto rays = rays_at(m, n, 0.75e-6f, seed);
                std::size_t escaped = 0;
                for (const auto& h : traced(m, rays))
                    escaped += h.triangle == no_id ? 1 : 0;
                EXPECT_EQ(escaped, 0u) << name << ", of " << n << ", seed " << seed;
            }
    }
};
TYPED_TEST_SUITE_P(mesh_rays);

TYPED_TEST_P(mesh_rays, hit_what_a_loop_over_all_triangles_hits)
{
    if (!this->divides_exactly())
        GTEST_SKIP() << "this device's division rounds loosely";
    for (const auto& [name, m, closed] : ray_meshes(400))
        for (const float from : {0.0f, 0.75f, 3.0f, 1e3f}) {
            const auto rays = rays_at(m, 400, from, 1, 3);
            const auto hits = this->traced(m, rays);
            for (std::size_t i = 0; i < hits.size(); ++i) {
                const auto expected = hit_by_all(m, rays.origins[i], rays.directions[i]);
                ASSERT_EQ(hits[i].triangle, expected.triangle) << name << ", from " << from << ", ray " << i;
                ASSERT_EQ(hits[i].distance, expected.distance) << name << ", from " << from << ", ray " << i;
            }
        }
}

TYPED_TEST_P(mesh_rays, go_on_from_pass_to_pass)
{
    const auto m = bumpy_ball(20, 1, 0.2f);
    const auto rays = rays_at(m, 200, 2, 2);
    const auto whole = this->traced(m, rays);
    EXPECT_EQ(this->traced(m, rays, {.steps_per_pass = 1}), whole);
    EXPECT_EQ(this->traced(m, rays, {.steps_per_pass = 7}), whole);
}

TYPED_TEST_P(mesh_rays, hit_anything_where_there_is_a_closest_hit)
{
    for (const auto& [name, m, closed] : ray_meshes(400)) {
        auto rays = rays_at(m, 300, 2, 3);
        for (std::size_t i = 0; i < rays.origins.size(); i += 2)
            rays.origins[i].w = 0.5f; // some end before
        const auto closest = this->traced(m, rays), any = this->traced(m, rays, {.kind = hit_kind::any});
        for (std::size_t i = 0; i < any.size(); ++i) {
            ASSERT_EQ(any[i].triangle == no_id, closest[i].triangle == no_id) << name << ", ray " << i;
            ASSERT_GE(any[i].distance, closest[i].distance) << name << ", ray " << i;
            ASSERT_LE(any[i].distance, rays.origins[i].w) << name << ", ray " << i;
        }
    }
}

TYPED_TEST_P(mesh_rays, never_leave_a_closed_mesh) { this->expect_no_escape(20000, 1); }
TYPED_TEST_P(mesh_rays, long_never_leave_a_closed_mesh) { this->expect_no_escape(333334, 10); }

TYPED_TEST_P(mesh_rays, hit_where_double_precision_says)
{
    const auto m = bumpy_ball(12, 1, 0.2f);
    const auto rays = rays_at(m, 1500, 3, 5);
    const auto hits = this->traced(m, rays);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (const auto expected = distance_in_double(m, rays.origins[i], rays.directions[i])) {
            ++compared;
            ASSERT_EQ(std::isinf(hits[i].distance), std::isinf(*expected)) << "ray " << i;
            if (std::isfinite(*expected)) {
                ASSERT_NEAR(static_cast<double>(hits[i].distance) / *expected, 1, 1e-4) << "ray " << i;
            }
        }
    EXPECT_GT(compared, hits.size() / 4);
}

TYPED_TEST_P(mesh_rays, hit_slivers_that_rounding_flattens)
{
    // The ray passes inside of each, exactly, and single precision sees none of the edges beside it.
    const mesh slivers[] = {
        {{{-0x1.2ea414p-1f, -0x1.cf3cp-4f, 1}, {0x1.09c118p-1f, 0x1.96c63p-4f, 1}, {0x1.475d32p-2f, 0x1.f5139ap-5f, 1}},
            {{0, 1, 2}}},
        {{{-0x1.e3f484p-1f, 0x1.19eb2p-4f, 1}, {0x1.4479e8p-1f, -0x1.7a08cap-5f, 1},
             {-0x1.90ad96p-1f, 0x1.d2d06ap-5f, 1}},
            {{0, 1, 2}}},
        {{{-0x1.71618cp-1f, 0x1.918c1p-1f, 1}, {0x1.2a3c2cp-1f, -0x1.4434a6p-1f, 1},
             {0x1.69be84p-3f, -0x1.893ec8p-3f, 1}},
            {{0, 1, 2}}}};
    for (const mesh& m : slivers) {
        const auto t = corners_of(m, 0);
        for (std::size_t c = 0; c < 3; ++c) { // of one sign, in arithmetic that is exact for them
            const glm::vec3 p = t[c], q = t[(c + 1) % 3], next = t[(c + 2) % 3];
            const auto exact = [](float x) { return static_cast<long double>(x); };
            const auto side = [&](const glm::vec3& a, const glm::vec3& b) {
                return exact(a.x) * exact(b.y) - exact(b.x) * exact(a.y);
            };
            ASSERT_GT(side(p, q) * side(q, next), 0);
            ASSERT_EQ(p.x * q.y, q.x * p.y);
        }
        const auto hits = this->traced(m, {{{0, 0, 0, 2}}, {{0, 0, 1, 0}}});
        EXPECT_EQ(hits[0], (ray_hit{1, 0}));
    }
}

TYPED_TEST_P(mesh_rays, hit_nothing_out_of_range)
{
    const auto m = bumpy_ball(6, 1, 0);
    constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const ray_set rays{{{0, 0, 0, inf}, {0, 0, 0, inf}, {nan, 0, 0, inf}, {0, -inf, 0, inf}, {0, 0, 0, inf},
                           {0, 0, 0, nan}, {0, 0, 0, 0}, {0, 0, 0, -1}, {0, 0, 0, 0.5f}, {1e19f, 0, 0, inf}},
        {{0, 0, 1, 0}, {0, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {nan, 0, 1, 0}, {0, 0, 1, 0}, {0, 0, 1, 0},
            {0, 0, 1, 0}, {0, 0, 1, 0}, {-1, 0, 0, 0}}};
    const auto hits = this->traced(m, rays);
    EXPECT_NEAR(hits[0].distance, 1, 1e-6);
    EXPECT_NE(hits[0].triangle, no_id);
    for (std::size_t i = 1; i < hits.size(); ++i)
        EXPECT_EQ(hits[i].triangle, no_id) << "ray " << i;
}

TEST(triangle_trees, say_what_is_wrong_with_a_mesh)
{
    const auto said = [](const mesh& m) -> std::string {
        try {
            (void)build_triangle_tree(m);
            return "";
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
    };
    const mesh good{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(said(good), "");
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(), 2e18f}) {
        auto m = good;
        m.positions[2].y = bad;
        EXPECT_EQ(said(m).find("mesh: positions[2]: coordinate 1 is "), 0u) << said(m);
    }
    auto m = good;
    m.triangles.push_back({0, 3, 1});
    EXPECT_EQ(said(m), "mesh: triangles[1]: corner 1 is vertex 3; there are 3");
    EXPECT_THROW(detail::require_countable((1u << 28) + 1), std::invalid_argument);
    EXPECT_NO_THROW(detail::require_countable(1u << 28));
}

/// That each pair is where the one above it says, with boxes around what is below, and ends at leaves in order.
inline void expect_whole(const triangle_tree& tree, const std::string& name)
{
    const auto pairs = static_cast<uint>(tree.pairs.size() / kernels::PAIR_RECORDS);
    std::vector<uint> visits(pairs, 0);
    uint next_triangle = 0;
    const std::function<detail::tree_box(uint, uint)> visit = [&](uint child, uint above) {
        detail::tree_box contents;
        if (kernels::is_leaf(child)) {
            EXPECT_EQ(kernels::first_of_leaf(child), next_triangle) << name;
            for (uint t = kernels::first_of_leaf(child); t < kernels::past_leaf(child); ++t)
                for (uint c = 0; c < 3; ++c)
                    contents.add(kernels::corner_of(tree.corners[kernels::TRIANGLE_RECORDS * t + c]));
            next_triangle = kernels::past_leaf(child);
            return contents;
        }
        ++visits[child];
        const auto* records = &tree.pairs[kernels::PAIR_RECORDS * child];
        EXPECT_EQ(records[2].w, above) << name << ", pair " << child;
        for (uint side = 0; side < 2; ++side) {
            const detail::tree_box box{
                kernels::corner_of(records[2 * side]), kernels::corner_of(records[2 * side + 1])};
            if (box.low.x > box.high.x)
                continue; // an empty child
            const auto found = visit(records[side].w, kernels::below_child(child, side));
            EXPECT_EQ(box.low, found.low) << name << ", pair " << child;
            EXPECT_EQ(box.high, found.high) << name << ", pair " << child;
            contents.add(box);
        }
        return contents;
    };
    (void)visit(0, kernels::NO_PAIR);
    EXPECT_EQ(next_triangle, tree.corners.size() / kernels::TRIANGLE_RECORDS) << name;
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1u), pairs) << name;
}

/// As the host builds it, and as the backend does.
TYPED_TEST_P(mesh_rays, are_searched_for_in_trees_that_hold_each_triangle_once)
{
    for (const auto& [name, m, closed] : ray_meshes(6000))
        for (const auto& tree : {build_triangle_tree(m), build_triangle_tree(this->b(), m)}) {
            std::vector<bool> seen(m.triangles.size());
            for (std::size_t t = 0; t < m.triangles.size(); ++t) {
                const uint index = tree.corners[kernels::TRIANGLE_RECORDS * t].w;
                ASSERT_LT(index, seen.size()) << name;
                EXPECT_FALSE(seen[index]) << name << ", triangle " << index;
                seen[index] = true;
            }
            expect_whole(tree, name);
            EXPECT_LE(tree.depth, kernels::DEEPEST_PAIR) << name;
            EXPECT_LE(tree.pairs.size(), kernels::PAIR_RECORDS * std::max<std::size_t>(m.triangles.size(), 1)) << name;
        }
}

REGISTER_TYPED_TEST_SUITE_P(mesh_rays, hit_what_a_loop_over_all_triangles_hits, go_on_from_pass_to_pass,
    hit_anything_where_there_is_a_closest_hit, never_leave_a_closed_mesh, long_never_leave_a_closed_mesh,
    hit_where_double_precision_says, hit_slivers_that_rounding_flattens, hit_nothing_out_of_range,
    are_searched_for_in_trees_that_hold_each_triangle_once);

} // namespace photongrid::testing
