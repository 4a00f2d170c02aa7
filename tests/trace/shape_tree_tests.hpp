// The tree of boxes over many shapes, on the serial backend: rays find what a loop over its leaves finds, bit for bit,
// and what a loop over all shapes finds but for rounding. The other backends equal serial with pictures of many lamps.
#pragma once

#include "rough_tests.hpp"

#include <photongrid/trace/shape_tree.hpp>

#include <random>

namespace photongrid::testing {
namespace {

    /// The tree holds each shape once, in boxes around it, and its walk is complete.
    void expect_a_tree_of(const std::vector<boxed_shape>& shapes, const std::vector<shape_node>& nodes)
    {
        ASSERT_EQ(nodes.size(), shapes.empty() ? 0 : 2 * shapes.size() - 1);
        std::vector<int> seen(shapes.size());
        std::vector<std::size_t> open; // the nodes that the walk is below
        std::size_t deepest = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            while (!open.empty() && nodes[open.back()].past <= i)
                open.pop_back();
            ASSERT_EQ(open.empty(), i == 0) << "one root";
            deepest = std::max(deepest, open.size());
            const auto& box = nodes[i].shape.box;
            if (!open.empty()) {
                const auto& around = nodes[open.back()].shape.box;
                ASSERT_TRUE(glm::all(glm::lessThanEqual(around.low, box.low)));
                ASSERT_TRUE(glm::all(glm::greaterThanEqual(around.high, box.high)));
                ASSERT_LE(nodes[i].past, nodes[open.back()].past);
            }
            if (nodes[i].is_leaf)
                ++seen[nodes[i].shape.at];
            else
                open.push_back(i);
            ASSERT_GT(nodes[i].past, i);
        }
        for (const int n : seen)
            ASSERT_EQ(n, 1);
        EXPECT_LE(deepest, 34 + std::log2(1.0 + double(shapes.size())));
    }

    void expect_a_tree(const std::vector<boxed_shape>& shapes)
    {
        expect_a_tree_of(shapes, build_shape_tree(shapes));
        const std::size_t apart = shapes.size() / 3, others = shapes.size() - apart;
        const auto nodes = build_shape_tree(shapes, apart);
        expect_a_tree_of(shapes, nodes);
        for (std::size_t i = 1; apart > 0 && i < nodes.size(); ++i)
            ASSERT_TRUE(!nodes[i].is_leaf || (nodes[i].shape.at < others) == (i < 2 * others))
                << "below the root's first child";
    }

    TEST(shape_tree, has_each_shape_once_and_bounded_depth)
    {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> u(-1, 1);
        for (const std::size_t n : {0u, 1u, 2u, 3u, 100u, 9000u}) {
            std::vector<boxed_shape> apart, equal, nested;
            for (std::uint32_t i = 0; i < n; ++i) {
                const glm::vec3 p(u(random), u(random), u(random));
                apart.push_back({{p, p + glm::vec3(0.1f)}, 0, i});
                equal.push_back({{glm::vec3(0), glm::vec3(1)}, 0, i});
                nested.push_back({{glm::vec3(std::exp2(-0.01f * float(i))), glm::vec3(1)}, 0, i});
            }
            for (const auto& shapes : {apart, equal, nested})
                expect_a_tree(shapes);
        }
    }

    /// A room of squares, with shapes of all kinds in it, some of them twice.
    scene many_shapes()
    {
        auto s = ball_of({"metal", material_kind::metal, {0.9, 0.6, 0.3}}, {0, 2.5, 0});
        s.spheres.clear();
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> u(-1, 1);
        const auto point = [&] { return 2.5 * dvec3(u(random), u(random), u(random)); };
        const auto way = [&] { return 0.3 * dvec3(u(random), u(random), u(random)); };
        for (std::uint32_t i = 0; i < 20; ++i) {
            s.spheres.push_back({point(), 0.2, i % 2});
            s.cylinders.push_back({point(), {}, 0.1, i % 2});
            s.cylinders.back().top = s.cylinders.back().base + way();
            s.cones.push_back({point(), {}, 0.15, i % 2});
            s.cones.back().apex = s.cones.back().base + way();
            s.paraboloids.push_back({point(), {}, 0.15, i % 2});
            s.paraboloids.back().rim = s.paraboloids.back().vertex + way();
            s.disks.push_back({point(), way(), 0.2, i % 2});
            const dvec3 corner = point(), a = glm::normalize(way()), b = turned_off(a, pi / 2, 0);
            s.boxes.push_back({corner, 0.3 * a, 0.2 * b, 0.1 * glm::cross(a, b), i % 2});
            const dvec3 p = point(), q = p + way(), r = p + way();
            s.polygons.push_back({{p, q, r}, i % 2});
            s.polygons.push_back({{p, r, p + 2.0 * (r - q)}, 0}); // shares an edge
            s.polygons.push_back({{p, q, r}, 0});                 // at the same place
        }
        constexpr int n = 8; // squares along an edge of the room
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-3.0, 3.0})
                for (int i = 0; i < n * n; ++i) {
                    dvec3 corner(0), e(0), f(0);
                    corner[axis] = side;
                    corner[(axis + 1) % 3] = -3 + 6.0 * (i % n) / n;
                    corner[(axis + 2) % 3] = -3 + 6.0 * (i / n) / n;
                    e[(axis + 1) % 3] = f[(axis + 2) % 3] = 6.0 / n;
                    s.polygons.push_back({{corner, corner + e, corner + e + f, corner + f}, 0});
                }
        s.rectangle_lights = {{"lamp", {-0.5, 2.9, -0.5}, {1, 0, 0}, {0, 0, 1}, dvec3(5)}};
        return s;
    }

    /// What eye rays hit, and the direct light there.
    struct found {
        std::vector<glm::vec4> points, directions, surfaces, light;
    };
    found find(serial_backend& b, const device_scene<serial_backend>& device, const scene& s,
        const std::vector<dvec3>& origins, const std::vector<dvec3>& ways)
    {
        const std::size_t n = origins.size();
        const auto hits = hits_of_step(b, device, origins, ways);
        auto light = b.make<glm::vec4>(n);
        auto settings = s.render;
        settings.view.light_samples = 4;
        detail::direct_light(b, device, {settings, 0, launch(n)}, hits, light);
        return {b.download(hits.points), b.download(hits.directions), b.download(hits.surfaces), b.download(light)};
    }

    TEST(shape_tree, finds_what_loops_find)
    {
        const auto s = many_shapes();
        serial_backend b;
        const auto device = upload_scene(b, s);
        ASSERT_NE(device.layout.features & has_shape_tree, 0u);

        // The same leaves, backwards and without nodes above them: a loop.
        auto flat = upload_scene(b, s);
        auto& records = flat.layout.records;
        const auto tree = flat.layout.table(kernels::SHAPE_TREE);
        std::vector<glm::vec4> leaves;
        for (uint n = tree.count; n-- > 0;)
            if (records[tree.first + 2 * n].w < 0) {
                leaves.push_back(records[tree.first + 2 * n]);
                leaves.push_back(records[tree.first + 2 * n + 1]);
            }
        EXPECT_EQ(leaves.size() / 2, count_shapes(s) + s.rectangle_lights.size());
        std::copy(leaves.begin(), leaves.end(), records.begin() + tree.first);
        records[kernels::SHAPE_TREE].y = records[kernels::SHAPE_TREE].w = static_cast<float>(leaves.size() / 2);
        flat.records = b.upload(std::span<const glm::vec4>(records));
        // No tree at all.
        auto without = upload_scene(b, s);
        without.layout.features &= ~uint{has_shape_tree};

        // Rays to anywhere, to corners and edges, and along walls.
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> u(-1, 1);
        std::vector<dvec3> origins, ways;
        for (std::size_t i = 0; i < 60000; ++i) {
            dvec3 from = 2.9 * dvec3(u(random), u(random), u(random)),
                  to = 3.0 * dvec3(u(random), u(random), u(random));
            if (i % 4 == 1) {
                const auto& p = s.polygons[i / 4 % s.polygons.size()].vertices;
                to = i % 8 == 1 ? p[0] : p[0] + 0.5 * (1 + u(random)) * (p[1] - p[0]);
            }
            if (i % 4 == 2)
                from.y = to.y = 3 - 1e-6 * double(i % 3);
            if (i % 4 == 3)
                from *= 300; // from outside, far away
            origins.push_back(from);
            ways.push_back(glm::normalize(to - from));
        }
        const auto by_tree = find(b, device, s, origins, ways), by_leaves = find(b, flat, s, origins, ways),
                   by_loop = find(b, without, s, origins, ways);
        const auto same = [](const std::vector<glm::vec4>& x, const std::vector<glm::vec4>& y) {
            return std::memcmp(x.data(), y.data(), x.size() * sizeof(glm::vec4)) == 0;
        };
        EXPECT_TRUE(same(by_tree.points, by_leaves.points));
        EXPECT_TRUE(same(by_tree.directions, by_leaves.directions));
        EXPECT_TRUE(same(by_tree.surfaces, by_leaves.surfaces));
        EXPECT_TRUE(same(by_tree.light, by_leaves.light));
        std::size_t escaped = 0, elsewhere = 0, lit = 0, other_light = 0;
        for (std::size_t i = 0; i < origins.size(); ++i) {
            const bool inside = i % 4 != 3;
            const bool missed = by_tree.points[i].w == -1 && by_loop.points[i].w >= 0;
            escaped += inside && missed ? 1 : 0;
            // From far away, rounding moves where a ray grazes a shape.
            elsewhere += inside && glm::distance(by_tree.points[i], by_loop.points[i]) > 1e-3f ? 1 : 0;
            lit += by_loop.light[i].x > 0 ? 1 : 0;
            other_light += std::abs(by_tree.light[i].x - by_loop.light[i].x) > 1e-3f * by_loop.light[i].x ? 1 : 0;
        }
        EXPECT_EQ(escaped, 0u);
        EXPECT_LE(elsewhere, origins.size() / 1000);
        EXPECT_GT(lit, origins.size() / 10);
        EXPECT_LE(other_light, origins.size() / 500);
    }

    /// A paraboloid bulges beyond its vertex and its rim.
    /// A room of squares under 49 lamps in one plane, the last of which is lower by `lower`.
    scene lamps_in_a_plane(double lower)
    {
        auto s = many_shapes();
        s.rectangle_lights.clear();
        for (int i = 0; i < 49; ++i)
            s.rectangle_lights.push_back(
                {"lamp", {-2.5 + 0.7 * (i % 7), 2.75 - (i == 48 ? lower : 0), -2.5 + 0.7 * (i / 7)}, {0.4, 0, 0},
                    {0, 0, 0.4}, dvec3(1)});
        return s;
    }

    // Where lamps block no light of each other, shadow rays to them leave the part of the tree out that holds them.
    TEST(shape_tree, keeps_lamps_apart_that_block_no_light)
    {
        const auto s = lamps_in_a_plane(0);
        serial_backend b;
        const auto device = upload_scene(b, s);
        const auto record = device.layout.records[kernels::SHAPE_TREE];
        EXPECT_EQ(record.w, 2.0f * static_cast<float>(count_shapes(s)));
        EXPECT_LT(record.w, record.y);
        auto whole = upload_scene(b, s);
        whole.layout.records[kernels::SHAPE_TREE].w = record.y;
        whole.records = b.upload(std::span<const glm::vec4>(whole.layout.records));
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> u(-1, 1);
        std::vector<dvec3> origins, ways;
        for (std::size_t i = 0; i < 20000; ++i) {
            origins.push_back(2.7 * dvec3(u(random), u(random), u(random)));
            ways.push_back(glm::normalize(dvec3(u(random), u(random), u(random))));
        }
        const auto apart = find(b, device, s, origins, ways), all = find(b, whole, s, origins, ways);
        std::size_t lit = 0;
        for (std::size_t i = 0; i < origins.size(); ++i) {
            lit += all.light[i].x > 0 ? 1 : 0;
            EXPECT_EQ(apart.light[i], all.light[i]) << i;
        }
        EXPECT_GT(lit, origins.size() / 10);

        const auto below = upload_scene(b, lamps_in_a_plane(0.5)).layout.records[kernels::SHAPE_TREE];
        EXPECT_EQ(below.w, below.y) << "the lowest lamp blocks light of the others";
    }

    TEST(shape_tree, boxes_hold_tilted_paraboloids_and_no_more)
    {
        std::mt19937_64 random(11);
        std::uniform_real_distribution<double> u(-1, 1);
        for (int i = 0; i < 50; ++i) {
            const dvec3 vertex(u(random), u(random), u(random)), axis(u(random), i % 5 == 0 ? 0 : u(random), u(random));
            const paraboloid x{vertex, vertex + axis, 1.5 + u(random), 0};
            bounds box, seen;
            shape_kind<paraboloid>::add_bounds(box, x);
            const dvec3 a = glm::normalize(axis);
            for (int j = 0; j <= 400; ++j)
                for (int k = 0; k < 720; ++k) {
                    const double share = j / 400.0; // of the radius
                    seen.add(
                        x.vertex + share * share * axis + share * x.radius * turned_off(a, pi / 2, 2 * pi * k / 720));
                }
            for (int c = 0; c < 3; ++c) {
                EXPECT_LE(box.low[c], seen.low[c] + 1e-12);
                EXPECT_GE(box.high[c], seen.high[c] - 1e-12);
                EXPECT_NEAR(box.low[c], seen.low[c], 1e-3);
                EXPECT_NEAR(box.high[c], seen.high[c], 1e-3);
            }
        }
    }

    /// Lamps stand before one another where a corner of one lies on the bright side of another.
    TEST(shape_tree, lamps_are_apart_where_none_stands_before_another)
    {
        const auto by_pairs = [](const std::vector<rectangle_light>& lamps, double least) {
            for (const auto& a : lamps)
                for (const auto& b : lamps)
                    for (const double u : {0.0, 1.0})
                        for (const double v : {0.0, 1.0})
                            if (glm::dot(glm::normalize(glm::cross(a.edge_u, a.edge_v)),
                                    b.corner + u * b.edge_u + v * b.edge_v - a.corner)
                                > least)
                                return false;
            return true;
        };
        std::mt19937 bits(4);
        const auto u = [&] { return static_cast<double>(bits()) * 0x1p-32; };
        int apart = 0;
        for (int i = 0; i < 300; ++i) {
            std::vector<rectangle_light> lamps;
            const int kind = i % 4;
            const std::size_t count = 2 + bits() % 9;
            for (std::size_t n = 0; n < count; ++n) {
                rectangle_light lamp{"", {u(), 2, u()}, {0.2 + u(), 0, 0}, {0, 0, 0.2 + u()}, dvec3(1)};
                if (kind == 1) // at other heights
                    lamp.corner.y += 1e-3 * u();
                if (kind == 2 && n % 2 == 1) { // back to back
                    std::swap(lamp.edge_u, lamp.edge_v);
                    lamp.corner.y += i % 8 == 2 ? 0.1 : -0.1;
                }
                if (kind == 3 && n == 1) // on another wall
                    lamp = {"", {3, u(), u()}, {0, 0, 0.3}, {0, i % 8 == 3 ? 0.3 : -0.3, 0}, dvec3(1)};
                lamps.push_back(lamp);
            }
            for (const double least : {1e-6, 5e-4}) {
                ASSERT_EQ(detail::lamps_block_none(lamps, least), by_pairs(lamps, least)) << i << ", " << least;
                apart += by_pairs(lamps, least) ? 1 : 0;
            }
        }
        EXPECT_GT(apart, 100);
        EXPECT_LT(apart, 500);
        // Those on the outside of a ball are apart, and too many to tell.
        std::vector<rectangle_light> ball;
        for (int i = 0; i < 3000; ++i) {
            const dvec3 n = glm::normalize(dvec3(u() - 0.5, u() - 0.5, u() - 0.5)),
                        x = glm::normalize(glm::cross(n, dvec3(0.3, 0.2, 1)));
            ball.push_back({"", n, 1e-4 * x, 1e-4 * glm::cross(n, x), dvec3(1)});
            if (i == 200) {
                EXPECT_TRUE(detail::lamps_block_none(ball, 1e-6));
            }
        }
        EXPECT_FALSE(detail::lamps_block_none(ball, 1e-6));
    }

    TEST(shape_tree, scenes_of_few_shapes_have_none)
    {
        auto s = ball_of({"metal", material_kind::metal, {0.9, 0.6, 0.3}}, {1.5, 0.5, 1});
        s.spheres.resize(detail::most_shapes_without_tree, {dvec3(5, 0, 0), 0.1, 0});
        EXPECT_EQ(lay_out(s).features & has_shape_tree, 0u);
        s.sphere_lights = {{"globe", {0, 5, 0}, 0.5, dvec3(4)}};
        EXPECT_NE(lay_out(s).features & has_shape_tree, 0u);
    }

} // namespace
} // namespace photongrid::testing
