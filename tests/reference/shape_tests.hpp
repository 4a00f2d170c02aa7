// Rays and shapes.
#pragma once

#include "reference_under_test.hpp"

namespace photongrid {
namespace {

    // --- rays and shapes ---
    using real = long double;
    using rvec = glm::vec<3, real>;

    /// Signed value of a shape's equation at p (scaled to metres), and whether p lies in the shape's extent.
    struct equation {
        std::function<real(const rvec&)> value;
        std::function<bool(const rvec&)> inside;
        real extent; ///< all of it lies within this distance of the origin
    };

    void expect_first_root(const scene& s, const equation& e, std::mt19937& random)
    {
        const reference::geometry shapes(s);
        std::normal_distribution<double> normal;
        int hits = 0, misses = 0;
        for (int n = 0; n < 1500; ++n) {
            dvec3 o(normal(random), normal(random), normal(random)),
                target(normal(random), normal(random), normal(random));
            o *= n % 3 == 0 ? 0.5 : n % 3 == 1 ? 3.0 : 1e4;
            const dvec3 d = glm::normalize(0.7 * target - o);
            const auto h = shapes.nearest({o, d, reference::nothing});
            const auto at = [&](real t) { return rvec(o) + rvec(d) * t; };
            const real middle = -glm::dot(rvec(o), rvec(d)), first = std::max<real>(0, middle - e.extent),
                       last = middle + e.extent;
            real root = std::numeric_limits<real>::infinity();
            const int steps = 1500;
            for (int i = 0; i < steps && !(root < last) && first < last; ++i) {
                real a = first + (last - first) * i / steps, b = first + (last - first) * (i + 1) / steps;
                if ((e.value(at(a)) < 0) == (e.value(at(b)) < 0))
                    continue;
                for (int k = 0; k < 70; ++k) {
                    const real m = (a + b) / 2;
                    ((e.value(at(m)) < 0) == (e.value(at(a)) < 0) ? a : b) = m;
                }
                if (e.inside(at(a)))
                    root = a;
            }
            const real scale = 1 + glm::length(rvec(o));
            if (h.shape == reference::nothing) {
                EXPECT_FALSE(root < last) << "missed at " << static_cast<double>(root);
                ++misses;
                continue;
            }
            ++hits;
            // What it says lies on the shape and on the ray; nothing lies before. A pair of roots within one step of
            // brute force is not seen by that, hence no equality.
            EXPECT_LT(std::abs(e.value(rvec(h.position))), 1e-12L);
            const real t = static_cast<real>(h.t);
            EXPECT_LT(glm::length(rvec(h.position) - at(t)), 1e-9L * scale);
            EXPECT_LT(t, root + 1e-9L * scale);
            EXPECT_NEAR(glm::length(h.normal), 1, 1e-12);
            // The normal is the equation's gradient, outward.
            const real eps = 1e-6L;
            rvec gradient(0);
            for (int k = 0; k < 3; ++k) {
                rvec step(0);
                step[k] = eps;
                gradient[k] = e.value(rvec(h.position) + step) - e.value(rvec(h.position) - step);
            }
            EXPECT_GT(glm::dot(glm::normalize(gradient), rvec(h.normal)), 1 - 1e-8L);
            // From there on: the root at the start is not found again, the next one is.
            const auto next = shapes.nearest({h.position, d, h.shape});
            if (next.shape != reference::nothing) {
                EXPECT_LT(std::abs(e.value(rvec(next.position))), 1e-12L);
                EXPECT_GT(next.t, 0);
            }
        }
        EXPECT_GT(hits, 100);
        EXPECT_GT(misses, 100);
    }

    TEST(reference, rays_hit_what_brute_force_hits)
    {
        std::mt19937 random(7);
        scene s = empty_scene();
        s.point_lights = {{"lamp", {0, 9, 0}, dvec3(1)}};
        const dvec3 a(0.2, -0.4, 0.1), b(-0.3, 0.5, 0.6);
        const rvec axis = glm::normalize(rvec(b) - rvec(a));
        const real height = glm::length(rvec(b) - rvec(a)), radius = 0.5L;
        const auto z = [=](const rvec& p) { return glm::dot(p - rvec(a), axis); };
        const auto off = [=](const rvec& p) { return glm::length(p - rvec(a) - z(p) * axis); };
        const auto between = [=](const rvec& p) { return z(p) >= 0 && z(p) <= height; };
        const auto only = [&](auto member, auto shape) {
            scene one = s;
            (one.*member).push_back(shape);
            return one;
        };
        const auto try_out = [&](const char* name, const scene& one, const equation& e) {
            SCOPED_TRACE(name);
            expect_first_root(one, e, random);
        };
        try_out("sphere", only(&scene::spheres, sphere{a, 0.5, 0}),
            {[=](const rvec& p) { return glm::length(p - rvec(a)) - radius; }, [](const rvec&) { return true; }, 1.2L});
        try_out("cylinder", only(&scene::cylinders, cylinder{a, b, 0.5, 0}),
            {[=](const rvec& p) { return off(p) - radius; }, between, 1.8L});
        try_out("cone", only(&scene::cones, cone{a, b, 0.5, 0}),
            {[=](const rvec& p) { return off(p) - radius * (1 - z(p) / height); }, between, 1.8L});
        try_out("paraboloid", only(&scene::paraboloids, paraboloid{a, b, 0.5, 0}),
            {[=](const rvec& p) { return off(p) * off(p) - radius * radius * z(p) / height; }, between, 1.8L});
        try_out("disk", only(&scene::disks, disk{a, b - a, 0.5, 0}),
            {[=](const rvec& p) { return z(p); }, [=](const rvec& p) { return off(p) <= radius; }, 1.8L});
        const dvec3 side = glm::normalize(glm::cross(b - a, dvec3(1, 0, 0)));
        const rvec edges[] = {rvec(b - a), rvec(0.4 * side), rvec(0.7 * glm::normalize(glm::cross(b - a, side)))};
        const auto place = [=](const rvec& p, int i) {
            return glm::dot(p - rvec(a), edges[i]) / glm::dot(edges[i], edges[i]) - 0.5L; // -1/2 to 1/2 inside
        };
        try_out("box", only(&scene::boxes, box{a, dvec3(edges[0]), dvec3(edges[1]), dvec3(edges[2]), 0}),
            {[=](const rvec& p) {
                 return std::max({std::abs(place(p, 0)), std::abs(place(p, 1)), std::abs(place(p, 2))}) - 0.5L;
             },
                [](const rvec&) { return true; }, 1.8L});
        // A pentagon: half-planes between neighbouring corners.
        const dvec3 u = reference::across(glm::normalize(b - a)), v = glm::cross(glm::normalize(b - a), u);
        polygon pentagon;
        for (int i = 0; i < 5; ++i)
            pentagon.vertices.push_back(a + 0.6 * (std::cos(1.2566 * i) * u + 1.3 * std::sin(1.2566 * i) * v));
        const auto inside = [=](const rvec& p) {
            for (std::size_t i = 0; i < 5; ++i) {
                const rvec from(pentagon.vertices[i]), to(pentagon.vertices[(i + 1) % 5]);
                if (glm::dot(glm::cross(to - from, p - from), axis) < 0)
                    return false;
            }
            return true;
        };
        try_out("polygon", only(&scene::polygons, pentagon), {[=](const rvec& p) { return z(p); }, inside, 1.8L});
    }

    TEST(reference, grazing_rays_and_edges)
    {
        scene s = empty_scene();
        s.point_lights = {{"lamp", {0, 9, 0}, dvec3(1)}};
        s.spheres = {{{0, 0, 0}, 1, 0}};
        const auto hits
            = [&](const reference::ray& r) { return reference::geometry(s).nearest(r).shape != reference::nothing; };
        EXPECT_TRUE(hits({{-1e6, 1 - 1e-9, 0}, {1, 0, 0}, reference::nothing}));
        EXPECT_FALSE(hits({{-1e6, 1 + 1e-9, 0}, {1, 0, 0}, reference::nothing}));
        // From the surface outward never again, inward always: however flat.
        for (double slope = 1; slope > 1e-15; slope /= 10) {
            EXPECT_FALSE(hits({{0, 1, 0}, glm::normalize(dvec3(1, slope, 0)), 0})) << slope;
            EXPECT_TRUE(hits({{0, 1, 0}, glm::normalize(dvec3(1, -slope, 0)), 0})) << slope;
        }
        // Two triangles of a square: every ray to their common edge, or next to it, hits one.
        s.spheres.clear();
        s.polygons = {{{{0, 0, 0}, {1, 0, 0.3}, {1, 1, 0.7}}, 0}, {{{0, 0, 0}, {1, 1, 0.7}, {0, 1, 0.4}}, 0}};
        std::mt19937 random(3);
        std::uniform_real_distribution<double> unit;
        for (int i = 0; i < 20000; ++i) {
            const dvec3 from(unit(random), unit(random), 3 + unit(random)),
                to = (0.01 + 0.98 * unit(random)) * dvec3(1, 1, 0.7);
            EXPECT_TRUE(hits({from, glm::normalize(to - from), reference::nothing}));
        }
    }

} // namespace
} // namespace photongrid
