// Where surfaces are, and where they end: rays at random against the reference renderer's intersections in double
// precision, rays at each edge of polygons, and how far off a surface its rays start.
#pragma once

#include "mesh_sets.hpp"
#include "probe_rays.hpp"

#include <photongrid/io/scene_file.hpp>
#include <photongrid/reference/intersect.hpp>
#include <photongrid/trace/mesh_search.hpp>

#include <numbers>

namespace photongrid::testing {
namespace {

    /// Rays from all around at a box, and a little beside it.
    struct aimed_rays {
        rays single;
        std::vector<reference::ray> exact;

        aimed_rays(const bounds& box, const dvec3& center, std::size_t n, std::uint64_t seed)
        {
            random_source u(seed);
            const dvec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
            for (std::size_t i = 0; i < n; ++i) {
                const auto within = [&](double factor) {
                    return middle
                        + factor * half
                        * dvec3(2 * static_cast<double>(u()) - 1, 2 * static_cast<double>(u()) - 1,
                            2 * static_cast<double>(u()) - 1);
                };
                const dvec3 target = within(1.02);
                const dvec3 from = middle + 3 * glm::length(half) * dvec3(random_direction(u));
                // The ray in float, and the same one in double.
                const glm::vec3 o(from - center), d(glm::normalize(target - from));
                single.add(o, d);
                exact.push_back({dvec3(o) + center, glm::normalize(dvec3(d))});
            }
        }
    };

    /// The reference's hit, and whether hits of rays slightly beside it differ: an edge or an outline is near.
    struct expectation {
        double t = 0; ///< infinite: a miss
        bool near_edge = false;
    };
    expectation expected_of(const reference::geometry& g, const reference::ray& r, double size)
    {
        expectation e{g.nearest(r).t, false};
        const dvec3 other = std::abs(r.direction.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const dvec3 u = glm::normalize(glm::cross(r.direction, other)), v = glm::cross(r.direction, u);
        for (const dvec3& way : {u, -u, v, -v}) {
            auto beside = r;
            beside.origin += 1e-5 * size * way;
            const double t = g.nearest(beside).t;
            e.near_edge = e.near_edge || std::isinf(t) != std::isinf(e.t)
                || (!std::isinf(t) && std::abs(t - e.t) > 1e-2 * size);
        }
        return e;
    }

    TEST(surfaces, are_where_the_reference_has_them)
    {
        const auto all = all_shapes();
        serial_backend b;
        int kinds = 0;
        for_each_shape(all, [&](const auto& list, auto kind) {
            for (std::size_t i = 0; i < list.size(); ++i) {
                SCOPED_TRACE(std::string(kind.name) + " " + std::to_string(i));
                ++kinds;
                scene s;
                s.name = "one shape";
                s.materials = all.materials;
                s.materials[list[i].material].kind = material_kind::lambertian;
                std::get<std::remove_cvref_t<decltype(list)>&>(shape_lists(s)).push_back(list[i]);
                bounds box;
                kind.add_bounds(box, list[i]);
                const double size = glm::length(box.high - box.low);
                s.point_lights = {{"bulb", 0.5 * (box.low + box.high) + dvec3(0, size, 0), dvec3(1)}};
                const auto layout = lay_out(s);
                const aimed_rays r(box, layout.center, 40000, 17 + i);
                const auto found = trace_rays(b, s, r.single);
                const reference::geometry exact(s);
                std::size_t hits = 0, edges = 0, wrong = 0;
                for (std::size_t n = 0; n < r.exact.size(); ++n) {
                    const auto e = expected_of(exact, r.exact[n], size);
                    edges += e.near_edge ? 1 : 0;
                    if (e.near_edge)
                        continue;
                    hits += std::isinf(e.t) ? 0 : 1;
                    const double t = static_cast<double>(found.places[n].w);
                    const bool same = std::isinf(e.t) ? !found.hit(n) : found.hit(n) && std::abs(t - e.t) < 1e-3 * size;
                    wrong += same ? 0 : 1;
                }
                EXPECT_EQ(wrong, 0u) << "of " << r.exact.size();
                EXPECT_GT(hits, 2000u);
                EXPECT_LT(edges, r.exact.size() / 50);
            }
        });
        EXPECT_GE(kinds, 10);
    }

    /// Places, normals and materials at hits, against the reference's in double precision.
    TEST(surfaces, of_meshes_are_where_the_reference_has_them)
    {
        auto s = empty_scene({0.5, 0.25, -3});
        s.materials.push_back({"grey", material_kind::lambertian, dvec3(0.5)});
        s.meshes.push_back(
            {"", std::make_shared<const mesh>(bumpy_ball(12, 1, 0.2f)), glm::dmat3(2), {0.5, 0.25, -3}, 0});
        s.meshes.push_back(
            {"", std::make_shared<const mesh>(smooth_ball(5)), glm::dmat3(0.4, 0, 0, 0.1, -0.3, 0, 0, 0, 0.5),
                {0.9, 0.25, -3}, static_cast<std::uint32_t>(s.materials.size() - 1)});
        serial_backend b;
        const auto device = upload_scene(b, s);
        const reference::geometry exact(s);
        random_source u(91);
        std::vector<glm::vec4> origins, directions;
        for (int i = 0; i < 4000; ++i) {
            origins.emplace_back(
                glm::vec3(dvec3(0.5, 0.25, -3) + 0.3 * dvec3(random_direction(u)) - device.layout.center), 3e38f);
            const dvec3 at = dvec3(0.9, 0.25, -3) + (i % 2 == 0 ? 0.5 : 3.0) * dvec3(random_direction(u))
                - device.layout.center - dvec3(glm::vec3(origins.back()));
            directions.emplace_back(glm::vec3(glm::normalize(at)), 0.0f);
        }
        detail::mesh_rays<serial_backend> rays(b, 0);
        rays.origins = upload(b, origins);
        rays.directions = upload(b, directions);
        detail::mesh_hits<serial_backend> hits(b, device, origins.size());
        rays.find(b, device, hits);
        const auto places = b.download(hits.places), normals = b.download(hits.normals),
                   shadings = b.download(hits.shadings);
        std::size_t smooth = 0, other = 0;
        for (std::size_t i = 0; i < origins.size(); ++i) {
            const auto h = exact.nearest(
                {dvec3(glm::vec3(origins[i])) + device.layout.center, glm::normalize(dvec3(glm::vec3(directions[i])))});
            ASSERT_NE(h.shape, reference::nothing);
            const dvec3 p = dvec3(glm::vec3(places[i])) + device.layout.center;
            // At an edge it may be the neighbour's, at the outline of the ball the wall's.
            if (glm::length(p - h.position) > 1e-4 || glm::dot(dvec3(glm::vec3(normals[i])), h.normal) < 1 - 1e-5) {
                ++other;
                continue;
            }
            EXPECT_EQ(normals[i].w, static_cast<float>(h.material));
            EXPECT_NEAR(static_cast<double>(places[i].w), h.t, 1e-4);
            EXPECT_LT(glm::length(dvec3(glm::vec3(shadings[i])) - h.shading), 1e-3) << i;
            smooth += glm::length(h.shading - h.normal) > 0.02 ? 1 : 0;
        }
        EXPECT_LE(other, 8u);
        EXPECT_GT(smooth, 500u);
    }

    /// A polygon ends at each of its edges alike: rays 10^-6 of its size inside hit it, and those as far outside miss,
    /// where the tests by half-spaces leave it open and every edge must be asked.
    TEST(surfaces, polygons_end_at_each_of_their_edges)
    {
        random_source u(7);
        serial_backend b;
        for (int corners = 3; corners <= 8; ++corners)
            for (int turn = 0; turn < 20; ++turn) {
                auto s = empty_scene({0.2, 0.1, 3});
                const dvec3 n(random_direction(u)), other = std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
                const dvec3 a = glm::normalize(glm::cross(n, other)), c = glm::cross(n, a);
                polygon p{{}, 0};
                const double first = 6 * static_cast<double>(u());
                for (int i = 0; i < corners; ++i) {
                    const double angle = first + 2 * std::numbers::pi * (i + 0.3 * static_cast<double>(u())) / corners;
                    p.vertices.push_back(std::cos(angle) * a + std::sin(angle) * c);
                }
                s.polygons = {p};
                const auto layout = lay_out(s);
                // Where the polygon ends, for each edge: the middle of its hits and misses, in steps of 10^-7.
                double least = 1, most = 0;
                for (int e = 0; e < corners; ++e) {
                    const dvec3 from = p.vertices[static_cast<std::size_t>(e)],
                                to = p.vertices[static_cast<std::size_t>((e + 1) % corners)],
                                outward = glm::normalize(glm::cross(to - from, n));
                    rays r;
                    constexpr int steps = 100, per_step = 10;
                    for (int i = 0; i < steps * per_step; ++i) {
                        const dvec3 target = glm::mix(from, to, 0.1 + 0.8 * static_cast<double>(u()))
                            + 1e-7 * (i / per_step) * outward;
                        r.add(glm::vec3(target + n - layout.center), glm::vec3(-n));
                    }
                    const auto found = trace_rays(b, s, r);
                    const double end = 1e-7 * static_cast<double>(r.size() - found.misses()) / per_step;
                    least = std::min(least, end);
                    most = std::max(most, end);
                }
                EXPECT_LE(most - least, 5e-7) << corners << " corners: an edge ends elsewhere";
                EXPECT_LE(most, 5e-6);
            }
    }

    /// Rays start off their surface by the error bound of trace/scene_layout.glsl, and by no more: 2^-19 of the sum of
    /// the coordinates, and of the largest curved shape.
    TEST(surfaces, rays_start_no_farther_off_than_rounding_asks)
    {
        auto s = all_shapes();
        serial_backend b;
        const auto layout = lay_out(s);
        bounds box;
        box.add({-2, 0, -2});
        box.add({2, 1.5, 2});
        const aimed_rays r(box, layout.center, 20000, 3);
        const auto found = trace_rays(b, s, r.single);
        const double curved = 0.85; // the cone's height and radius; others are smaller
        double largest = 0;
        std::size_t hits = 0;
        for (std::size_t i = 0; i < r.exact.size(); ++i) {
            if (!found.hit(i))
                continue;
            ++hits;
            const dvec3 p(glm::vec3(found.places[i])), start(glm::vec3(found.starts[i]));
            const double bound = 0x1p-19 * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z) + curved);
            largest = std::max(largest, glm::length(start - p) / bound);
        }
        EXPECT_GT(hits, 5000u);
        EXPECT_GT(largest, 0.3);
        EXPECT_LE(largest, 2.2) << "twice, where a box moves a hit off its other faces";
    }

} // namespace
} // namespace photongrid::testing
