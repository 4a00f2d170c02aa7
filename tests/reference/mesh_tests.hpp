// Meshes of the reference renderer: rays against a loop over all triangles in long double, and pictures of polygons as
// meshes.
#pragma once

#include "../trace/mesh_sets.hpp"
#include "reference_under_test.hpp"

#include <photongrid/reference/intersect.hpp>

namespace photongrid {
namespace {

    using vec3l = glm::vec<3, long double>;

    /// The closest hit, from the areas that the ray cuts off the triangle: positive on one side, all three alike.
    long double closest_of_all(const placed_mesh& m, const reference::ray& r)
    {
        long double closest = std::numeric_limits<long double>::infinity();
        const vec3l o(r.origin), d(r.direction);
        for (std::size_t t = 0; t < m.surface->triangles.size(); ++t) {
            const auto c = corners_of(m, t);
            const vec3l a = vec3l(c[0]) - o, b = vec3l(c[1]) - o, e = vec3l(c[2]) - o;
            const long double u = glm::dot(d, glm::cross(e, b)), v = glm::dot(d, glm::cross(a, e)),
                              w = glm::dot(d, glm::cross(b, a));
            if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) {
                const long double at = glm::dot(glm::cross(b - a, e - a), a) / glm::dot(glm::cross(b - a, e - a), d);
                if (at > 0)
                    closest = std::min(closest, at);
            }
        }
        return closest;
    }

    TEST(reference_meshes, rays_hit_what_a_loop_over_all_triangles_hits)
    {
        auto s = empty_scene();
        s.point_lights = {{"bulb", dvec3(0), dvec3(1)}};
        s.meshes = {{"", std::make_shared<const mesh>(testing::bumpy_ball(20, 1, 0.2f)),
            glm::dmat3(2, 0, 0, 0, 1, 0.5, 0, 0, 3), {0.25, 4, -1}, white}};
        const reference::geometry g(s);
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> u(-1, 1);
        std::size_t hits = 0;
        for (int i = 0; i < 4000; ++i) {
            const dvec3 from = s.meshes[0].offset + (i % 2 == 0 ? 0.4 : 8.0) * dvec3(u(random), u(random), u(random)),
                        at = s.meshes[0].offset + 2.0 * dvec3(u(random), u(random), u(random));
            const reference::ray r{from, glm::normalize(at - from)};
            const auto expected = closest_of_all(s.meshes[0], r);
            const auto h = g.nearest(r);
            ASSERT_EQ(std::isinf(h.t), std::isinf(expected)) << i;
            if (std::isinf(h.t))
                continue;
            ++hits;
            EXPECT_NEAR(h.t, static_cast<double>(expected), 1e-12 * h.t);
            EXPECT_EQ(h.material, white);
            EXPECT_TRUE(g.blocked(r, h.t * (1 + 1e-9), reference::nothing));
            EXPECT_FALSE(g.blocked(r, h.t * (1 - 1e-9), reference::nothing));
            const reference::ray on{h.position, r.direction, h.shape};
            EXPECT_NE(g.nearest(on).shape, h.shape) << "hits the triangle on which it starts";
        }
        EXPECT_GT(hits, 2000u);
    }

    TEST(reference_meshes, draw_what_their_polygons_draw)
    {
        const auto s = testing::small_cornell();
        auto m = testing::with_meshes(s);
        m.mesh_lights = {{"lamp", testing::mesh_of(surface_of(s.rectangle_lights[0])), s.rectangle_lights[0].power}};
        m.rectangle_lights.clear();
        auto settings = quick(24, 24, 64);
        settings.paths = 1 << 18;
        settings.area_light_caustics = caustics_by::bins; // of the triangles too
        const auto a = render_reference(s, s.camera, settings), b = render_reference(m, m.camera, settings);
        std::size_t off = 0;
        for (std::size_t i = 0; i < a.mean.pixels.size(); ++i) {
            const dvec3 difference(b.mean.pixels[i] - a.mean.pixels[i]),
                error = dvec3(a.standard_error.pixels[i]) + dvec3(b.standard_error.pixels[i]);
            off += glm::all(glm::lessThanEqual(glm::abs(difference), 4.0 * error + 1e-6)) ? 0 : 1;
        }
        EXPECT_LE(off, a.mean.pixels.size() / 50);
        EXPECT_GT(b.stats.caustic_hits, a.stats.caustic_hits / 2);
    }

} // namespace
} // namespace photongrid
