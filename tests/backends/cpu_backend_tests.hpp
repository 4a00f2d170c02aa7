// What only the cpu backend promises: the same bytes at any number of threads and on any instruction set, buffers that
// can be turned over, overrides that equal the generic algorithms.
#pragma once

#include "cpu_algorithms.hpp"
#include <photongrid/backends/cpu/overrides/radix_sort.hpp>

#include "../map/photon_generator.hpp"
#include "../trace/instance_tests.hpp"
#include "serial_algorithms.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstring>
#include <thread>

namespace photongrid::testing {
namespace {
    using glm::uvec2;
    using glm::uvec3;
    using glm::vec4;

    /// All results of a search.
    struct findings {
        std::vector<vec4> irradiance, errors, boxes;
        std::vector<uvec2> used, cells;
        std::vector<uint> list;
        bool operator==(const findings& other) const
        {
            return count_different_bits(irradiance, other.irradiance) + count_different_bits(errors, other.errors)
                + count_different_bits(used, other.used) + count_different_bits(cells, other.cells)
                + count_different_bits(boxes, other.boxes) + count_different_bits(list, other.list)
                == 0;
        }
    };

    /// A kind of map and a number of photons sought: in block maps the cpu backend searches in one way for few photons,
    /// in another for many.
    struct searched_map {
        map_kind kind;
        uint k;
    };
    constexpr searched_map searched_maps[] = {{map_kind::sorted, 70}, {map_kind::blocks, 70}, {map_kind::blocks, 3}};

    findings find(cpu_backend& b, const searched_map& in, distribution d, search_kind search, filter_kind filter,
        const leak_policy& leaks)
    {
        auto set = make_photons(d, 6000, {12, 12, 12}, 3);
        const auto points = make_points(set, 1000, 3);
        random_source u(5);
        std::vector<vec4> directions, normals;
        for (std::size_t i = 0; i < set.positions.size(); ++i) {
            directions.push_back(glm::normalize(vec4(u() - 0.5f, u() - 0.5f, u() - 0.5f, 0.0f)));
            normals.push_back(glm::normalize(vec4(u() - 0.5f, u() - 0.5f, u() - 0.5f, 0.0f)));
        }
        const std::vector<vec4> up(points.size(), vec4(0, 1, 0, 0));
        auto p = upload_photons(b, set);
        p.directions = b.upload(std::span<const vec4>(directions));
        p.normals = b.upload(std::span<const vec4>(normals));
        const auto map = make_map(b, in.kind, std::move(p), set.g);
        knn_settings k{.k = in.k, .max_radius = 0.3f};
        k.search = search;
        k.filter = filter;
        k.leaks = leaks;
        k.errors = search != search_kind::at_least_k || filter != filter_kind::constant;
        if (!k.errors)
            k.bias = bias_kind::paper; // adds up while it searches
        const auto e = knn_grid_estimate(
            b, map, b.upload(std::span<const vec4>(points)), b.upload(std::span<const vec4>(up)), k);
        return {b.download(e.irradiance), b.download(e.standard_error), b.download(map.boxes), b.download(e.used),
            b.download(map.cells), b.download(map.list)};
    }
} // namespace

TEST(cpu_backend, threads_do_not_change_a_byte)
{
    for (const auto d : all_distributions)
        for (const auto search : {search_kind::at_least_k, search_kind::exact_k, search_kind::fixed_radius})
            for (const auto& in : searched_maps) {
                std::vector<findings> all;
                for (const uint threads : {1u, 2u, 5u}) {
                    cpu_backend b(threads);
                    all.push_back(find(b, in, d, search, filter_kind::silverman, {.side = true}));
                }
                EXPECT_TRUE(all[0] == all[1] && all[0] == all[2])
                    << name_of(d) << " search " << static_cast<int>(search) << " " << name_of(in.kind) << " k " << in.k;
            }
}

TEST(cpu_backend, instruction_sets_do_not_change_a_byte)
{
    cpu_backend b(1);
    const leak_policy policies[] = {{}, {.side = true}, {.side = true, .min_cosine = -0.5f, .flattening = 1.5f}};
    const auto targets = hwy::SupportedAndGeneratedTargets();
    ASSERT_FALSE(targets.empty());
    for (const auto d : {distribution::uniform, distribution::clustered, distribution::box_faces})
        for (const auto search : {search_kind::at_least_k, search_kind::exact_k})
            for (const auto& filter : filters)
                for (const auto& leaks : policies)
                    for (const auto& in : searched_maps) {
                        std::vector<findings> all;
                        for (const auto target : targets) {
                            hwy::SetSupportedTargetsForTest(target);
                            hwy::GetChosenTarget().DeInit();
                            all.push_back(find(b, in, d, search, filter.kind, leaks));
                            hwy::SetSupportedTargetsForTest(0);
                            hwy::GetChosenTarget().DeInit();
                        }
                        for (std::size_t t = 1; t < all.size(); ++t)
                            EXPECT_TRUE(all[t] == all[0])
                                << hwy::TargetName(targets[t]) << " against " << hwy::TargetName(targets[0]) << ", "
                                << name_of(d) << " search " << static_cast<int>(search) << " filter " << filter.name
                                << " " << name_of(in.kind) << " k " << in.k;
                    }
    std::string names;
    for (const auto target : targets)
        names += std::string(" ") + hwy::TargetName(target);
    std::printf("compared:%s\n", names.c_str());
}

TEST(cpu_backend, points_do_not_depend_on_the_others_but_for_rounding)
{
    // Alone, in reverse order and among others a point finds the same photons.
    cpu_backend b(2);
    const auto set = make_photons(distribution::clustered, 10000, {16, 16, 16}, 2);
    const auto points = make_points(set, 500, 2);
    for (const auto& in : searched_maps) {
        const auto map = make_map(b, in.kind, upload_photons(b, set), set.g);
        const knn_settings k{.k = in.k, .max_radius = 0.5f};
        const auto together = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), k);
        const auto irradiance = b.download(together.irradiance);
        const auto used = b.download(together.used);
        for (std::size_t i = 0; i < points.size(); i += 7) {
            const auto alone = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(&points[i], 1)), k);
            EXPECT_EQ(b.download(alone.irradiance)[0].w, irradiance[i].w);
            EXPECT_EQ(b.download(alone.used)[0].x, used[i].x);
            EXPECT_NEAR(b.download(alone.irradiance)[0].x, irradiance[i].x, 1e-6f * irradiance[i].x);
        }
    }
}

/// Each cluster is 2^18 times as dense as the next larger, so the distance found for a point says nothing about a point
/// in another cluster.
TEST(cpu_backend, searches_in_blocks_visit_few_photons_wherever_the_points_lie)
{
    cpu_backend b(2);
    random_source u(4);
    photon_set set;
    for (uint i = 0; i < 100000; ++i) {
        const float size = std::ldexp(1.0f, -6 * static_cast<int>(i % 4));
        set.positions.emplace_back(glm::vec3(0.5f) + size * (glm::vec3(u(), u(), u()) - 0.5f), 0.0f);
        set.powers.emplace_back(1);
    }
    const auto map = block_map(b, upload_photons(b, set));
    for (const std::size_t points : {100u, 3000u})
        for (const uint k : {1u, 10u, 100u}) {
            std::vector<vec4> at;
            for (std::size_t i = 0; i < points; ++i)
                at.emplace_back(glm::vec3(set.positions[i * 31]), 1.0f);
            const auto e = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(at)), {.k = k});
            uint most = 0;
            for (const auto& used : b.download(e.used))
                most = std::max(most, used.y);
            EXPECT_LT(most, 5000 + 50 * k) << points << " points, k " << k;
        }
}

TEST(cpu_backend, buffers_can_be_turned_over)
{
    cpu_backend b(3);
    for (const std::size_t n : {0u, 1u, 15u, 16u, 17u, 40000u}) {
        random_source u(n);
        std::vector<vec4> host(n);
        for (auto& v : host)
            v = {u(), -u(), u() * 1e30f, u() * 1e-30f};
        const auto device = b.upload(std::span<const vec4>(host));
        const auto before = b.bytes();
        const auto p = b.components(device);
        for (std::size_t i = 0; i < n; ++i)
            ASSERT_TRUE(p.x[i] == host[i].x && p.y[i] == host[i].y && p.z[i] == host[i].z && p.w[i] == host[i].w);
        EXPECT_EQ(count_different_bits(b.download(device), host), 0u);
        EXPECT_EQ(b.bytes(), before);
    }
}

TEST(cpu_backend, radix_sort_equals_std_sort)
{
    cpu::pool one(1), three(3);
    EXPECT_TRUE(rc::check("any keys and values", [&] {
        const auto blocks = *photon_numbers(400); // of 125 pairs, and some more
        const auto n = 125 * blocks.size() + *rc::gen::inRange<std::size_t>(0, 125);
        const auto keys = *rc::gen::element(1u, 3u, 2000u, 70000u, 0xFFFFFFFFu),
                   values = *rc::gen::element(0u, 1u, 5000u, 0xFFFFFFFFu);
        random_source u(0);
        std::vector<uvec2> pairs(n);
        for (std::size_t i = 0; i < n; ++i) { // values 0: ascending, as ids are
            if (i % 125 == 0)
                u = random_source(i / 125 < blocks.size() ? blocks[i / 125] : 0);
            pairs[i] = {
                u.below(50) == 0 ? 0xFFFFFFFFu : u.below(keys), values == 0 ? static_cast<uint>(i) : u.below(values)};
        }
        auto expected = pairs;
        std::sort(
            expected.begin(), expected.end(), [](uvec2 a, uvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
        for (auto* threads : {&one, &three}) {
            const cpu::storage first((n + 8) * sizeof(uvec2)), second((n + 8) * sizeof(uvec2));
            auto* const here = reinterpret_cast<uvec2*>(first.begin());
            auto* const there = reinterpret_cast<uvec2*>(second.begin());
            std::copy(pairs.begin(), pairs.end(), here);
            const auto* const sorted = cpu::radix_sort(*threads, here, there, n).in_scratch ? there : here;
            RC_ASSERT(std::equal(expected.begin(), expected.end(), sorted));
        }
    }));
}

TEST(cpu_backend, maps_equal_the_generic_ones)
{
    cpu_backend b(2);
    serial_backend serial;
    for (const auto d : all_distributions)
        for (const uint parts : {every_part, caustic_part, other_part}) {
            auto set = make_photons(d, 7000, {13, 11, 7}, 4);
            for (std::size_t i = 0; i < set.positions.size(); i += 3)
                set.positions[i].w = 1;
            set.positions[100].x = std::numeric_limits<float>::quiet_NaN();
            set.powers[101].y = std::numeric_limits<float>::infinity();
            const auto mine = sorted_map(b, upload_photons(b, set), set.g, parts);
            const auto theirs = sorted_map(serial, upload_photons(serial, set), set.g, parts);
            EXPECT_EQ(mine.invalid, theirs.invalid);
            EXPECT_EQ(mine.left_out, theirs.left_out);
            EXPECT_EQ(count_different_bits(b.download(mine.cells), serial.download(theirs.cells)), 0u);
            EXPECT_EQ(count_different_bits(b.download(mine.list), serial.download(theirs.list)), 0u);
            EXPECT_EQ(
                count_different_bits(b.download(mine.photons.positions), serial.download(theirs.photons.positions)),
                0u);
            EXPECT_EQ(
                count_different_bits(b.download(mine.photons.powers), serial.download(theirs.photons.powers)), 0u);
        }
}

TEST(cpu_backend, the_growing_search_visits_and_holds_what_serials_does)
{
    // The result depends on the order of visits: any grid, any k, with many or few photons per cell.
    cpu_backend b(2);
    serial_backend serial;
    EXPECT_TRUE(rc::check("held, visited, radius: the same bits", [&] {
        const auto d = *any_distribution();
        const auto resolution = *rc::gen::element(
            uvec3(1, 1, 1), uvec3(20, 1, 20), uvec3(5, 5, 10), uvec3(1, 1, 40), uvec3(3, 50, 2), uvec3(17, 33, 18));
        const auto numbers = *photon_numbers(5000);
        const auto k = *rc::gen::element(1u, 2u, 15u, 16u, 17u, 50u, 333u, 5000u);
        const auto radius = *rc::gen::element(1e-4f, 0.03f, 0.2f, 0.7f, 10.0f);
        const auto leaks = *rc::gen::element(leak_policy{}, leak_policy{.side = true},
            leak_policy{.side = true, .min_cosine = -0.5f, .flattening = 1.5f});
        const auto s = make_oriented(d, numbers, resolution, 40);
        for (const auto& kind : {bias_kind::paper, bias_kind::unbiased}) {
            auto settings = as_paper(knn_settings{.k = k, .max_radius = radius});
            settings.leaks = leaks;
            settings.bias = kind;
            const auto found = [&](auto& device) {
                auto photons = upload_photons(device, s.photons);
                photons.directions = device.upload(std::span<const vec4>(s.directions));
                photons.normals = device.upload(std::span<const vec4>(s.normals));
                const auto map = sorted_map(device, std::move(photons), s.photons.g);
                const auto e = knn_grid_estimate(device, map, device.upload(std::span<const vec4>(s.points)),
                    device.upload(std::span<const vec4>(s.point_normals)), settings);
                return std::pair{device.download(e.irradiance), device.download(e.used)};
            };
            const auto [light, used] = found(b);
            const auto [light_s, used_s] = found(serial);
            for (std::size_t i = 0; i < used.size(); ++i) {
                RC_ASSERT(used[i].x == used_s[i].x);
                if (kind == bias_kind::paper) { // for the other the kernels go through the photons once more
                    RC_ASSERT(used[i].y == used_s[i].y);
                }
                RC_ASSERT(light[i].w == light_s[i].w);
                for (int c = 0; c < 3; ++c)
                    RC_ASSERT(std::abs(light[i][c] - light_s[i][c]) <= 1e-5f * light_s[i][c]);
            }
        }
    }));
}

TEST(cpu_backend, throws_for_too_many_threads_and_too_large_buffers)
{
    EXPECT_THROW(cpu_backend(5000), std::invalid_argument);
    cpu_backend b(1);
    EXPECT_THROW((void)b.make<vec4>(std::size_t{1} << 40), backend_error);
}

TEST(cpu_backend, two_backends_work_side_by_side)
{
    findings a, c;
    std::thread first([&] {
        cpu_backend b(2);
        a = find(b, searched_maps[0], distribution::uniform, search_kind::exact_k, filter_kind::cone, {});
    });
    std::thread second([&] {
        cpu_backend b(2);
        c = find(b, searched_maps[0], distribution::uniform, search_kind::exact_k, filter_kind::cone, {});
    });
    first.join();
    second.join();
    EXPECT_TRUE(a == c);
}

/// A tree does not depend on threads; and leaves of up to eight triangles, which this backend's tree has from the
/// start, are those that it makes of the host's tree.
TEST(cpu_backend, trees_depend_neither_on_threads_nor_on_smaller_leaves)
{
    cpu_backend one(1);
    const auto equal = [](cpu_backend& a, const cpu::buffer<float>& x, cpu_backend& b, const cpu::buffer<float>& y) {
        const auto m = a.download(x), n = b.download(y);
        return m.size() == n.size() && std::memcmp(m.data(), n.data(), m.size() * sizeof(float)) == 0;
    };
    for (const auto& [name, m, closed] : ray_meshes(12000)) {
        const auto expected = build_triangle_tree(one, m);
        const auto wide = upload_triangles(one, expected), from_small = upload_triangles(one, build_triangle_tree(m));
        for (const uint threads : {2u, 5u}) {
            cpu_backend several(threads);
            const auto tree = build_triangle_tree(several, m);
            EXPECT_EQ(tree.pairs, expected.pairs) << name << ", " << threads << " threads";
            EXPECT_EQ(tree.corners, expected.corners) << name << ", " << threads << " threads";
            EXPECT_EQ(tree.depth, expected.depth) << name << ", " << threads << " threads";
            const auto again = upload_triangles(several, tree);
            EXPECT_TRUE(equal(one, wide.nodes, several, again.nodes)) << name << ", " << threads << " threads";
            EXPECT_TRUE(equal(one, wide.blocks, several, again.blocks)) << name << ", " << threads << " threads";
        }
        if (m.triangles.size() > cpu::wide) { // fewer are one leaf, but two in the host's tree
            EXPECT_TRUE(equal(one, wide.nodes, one, from_small.nodes)) << name;
        }
    }
    const auto ball = bumpy_ball(30, 1, 0.2f);
    const auto s = instances_about(ball, bumpy_ball(12, 1, 0.1f), 20, 4);
    const auto expected = upload_triangles(one, build_instance_tree(one, s.surfaces, s.placements));
    const auto from_small = upload_triangles(one, build_instance_tree(s.surfaces, s.placements));
    cpu_backend several(5);
    const auto again = upload_triangles(several, build_instance_tree(several, s.surfaces, s.placements));
    EXPECT_TRUE(equal(one, expected.nodes, several, again.nodes));
    EXPECT_TRUE(equal(one, expected.blocks, several, again.blocks));
    EXPECT_TRUE(equal(one, expected.nodes, one, from_small.nodes));
}

/// One by one, from several threads at once, rays hit what many together hit.
TEST(cpu_backend, single_rays_hit_what_batches_hit)
{
    cpu_backend b(2);
    const auto s = instances_about(bumpy_ball(12, 1, 0.2f), bumpy_ball(8, 1, 0.1f), 20, 4);
    const mesh m = flattened(s);
    auto rays = rays_at(m, 3000, 5, 2, 2);
    rays.origins[0].w = 0.5f;
    rays.origins[1].x = std::numeric_limits<float>::quiet_NaN();
    rays.directions[2] = vec4(0);
    rays.origins[3].w = 0;
    for (const auto& triangles : {upload_triangles(b, build_triangle_tree(b, m)),
             upload_triangles(b, build_instance_tree(b, s.surfaces, s.placements))}) {
        const auto all = trace_rays(b, triangles, upload(b, rays.origins), upload(b, rays.directions));
        std::vector<ray_hit> closest(all.size()), any(all.size());
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < 3; ++t)
            threads.emplace_back([&, t] {
                for (std::size_t i = t; i < all.size(); i += 3) {
                    closest[i] = trace_ray(b, triangles, rays.origins[i], rays.directions[i]);
                    any[i] = trace_ray(b, triangles, rays.origins[i], rays.directions[i], hit_kind::any);
                }
            });
        for (auto& t : threads)
            t.join();
        std::size_t hits = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            ASSERT_EQ(closest[i].triangle, all[i].triangle) << i;
            if (i != 1) {
                ASSERT_EQ(closest[i].distance, all[i].distance) << i;
            }
            ASSERT_EQ(any[i].triangle == no_id, all[i].triangle == no_id) << i;
            hits += all[i].triangle == no_id ? 0 : 1;
        }
        EXPECT_GT(hits, 500u);
        for (const std::size_t refused : {1u, 2u, 3u})
            EXPECT_EQ(closest[refused].triangle, no_id);
    }
}

} // namespace photongrid::testing
