// Caustics of mirrors against ray density.
#pragma once

#include "landed_photons.hpp"

namespace photongrid::testing {
namespace {

    // --- mirror cylinders
    // -------------------------------------------------------------------------------------------------
    //
    // A standing cylinder turns horizontal directions as a circle does and leaves heights alone, so seen from above its
    // light on the floor is the plane problem, whatever the lamp's height.

    using plane_curve = std::function<dvec2(double)>;

    /// How far the brightest line lies from a curve, and how much darker it is beyond it.
    struct ridge {
        double largest_offset = 0, mean_offset = 0; ///< cells
        double dark_over_bright = 0; ///< density 1 to 2 cells beyond the curve over that of the first cell before it
        int stations = 0;
    };

    /// Looks along the curve's normal at each parameter. Rays are tangents of their envelope and tangents run on the
    /// convex side, so that side is bright.
    ridge find_ridge(
        const std::vector<dvec2>& photons, const plane_curve& curve, const std::vector<double>& parameters, double cell)
    {
        ridge out;
        double dark = 0, bright = 0;
        for (const double t : parameters) {
            const double h = 1e-4;
            const dvec2 c = curve(t), d1 = (curve(t + h) - curve(t - h)) / (2 * h),
                        d2 = (curve(t + h) - 2.0 * c + curve(t - h)) / (h * h);
            const double turn = (d1.x * d2.y - d1.y * d2.x) / std::pow(glm::length(d1), 3); // curvature, with its sign
            const dvec2 along = glm::normalize(d1), convex = dvec2(along.y, -along.x) * (turn > 0 ? 1.0 : -1.0);
            constexpr int halves = 10; // half cells on either side
            std::vector<int> count(2 * halves, 0);
            for (const auto& p : photons) {
                const dvec2 v = p - c;
                const double s = glm::dot(v, along);
                if (std::abs(s) > 2 * cell)
                    continue;
                const double u = (glm::dot(v, convex) + 0.5 * std::abs(turn) * s * s)
                    / cell; // to second order off the curve itself
                if (std::abs(u) < 0.5 * halves)
                    ++count[static_cast<std::size_t>(std::floor(2 * u) + halves)];
                dark += u > -2 && u < -1 ? 1 : 0;
                bright += u > 0 && u < 1 ? 1 : 0;
            }
            const auto peak = std::max_element(count.begin(), count.end()) - count.begin();
            const double offset = (static_cast<double>(peak) + 0.5 - halves) / 2;
            EXPECT_LE(std::abs(offset), 1)
                << "cells off the curve at parameter " << t
                << "; photons in the brightest half cell: " << count[static_cast<std::size_t>(peak)];
            out.largest_offset = std::max(out.largest_offset, std::abs(offset));
            out.mean_offset += std::abs(offset);
            ++out.stations;
        }
        out.mean_offset /= std::max(out.stations, 1);
        out.dark_over_bright = dark / std::max(bright, 1.0);
        return out;
    }

    std::vector<double> both_sides(double from, double to, int n, double middle = 0)
    {
        std::vector<double> out;
        for (int i = 0; i < n; ++i) {
            const double t = from + (to - from) * i / (n - 1);
            out.push_back(middle + t);
            out.push_back(middle - t);
        }
        return out;
    }

    void expect_ridge(const char* name, const std::vector<dvec2>& photons, const plane_curve& curve,
        const std::vector<double>& parameters, double cell)
    {
        const auto r = find_ridge(photons, curve, parameters, cell);
        std::printf("%s: %zu photons, ridge at %d places off the curve by %.2f cells on average, %.2f at most; beyond "
                    "it %.3f of the density\n",
            name, photons.size(), r.stations, r.mean_offset, r.largest_offset, r.dark_over_bright);
        EXPECT_LT(r.mean_offset, 0.35) << name << ": the first half cell on the bright side is 0.25 off";
        EXPECT_LT(r.dark_over_bright, 0.5) << name;
        EXPECT_GT(photons.size(), 50000u);
    }

    /// The floor inside a mirror cylinder about the y axis.
    scene mirror_cylinder(double radius, double height)
    {
        scene s;
        s.name = "mirror_cylinder";
        s.materials = {{"black", material_kind::lambertian, dvec3(0)}, {"mirror", material_kind::mirror, dvec3(1)}};
        s.disks = {{{0, 0, 0}, {0, 1, 0}, 0.999 * radius, 0}};
        s.cylinders = {{{0, 0, 0}, {0, height, 0}, radius, 1}};
        s.camera = {{0, 3, 3}, {0, 0, 0}, {0, 1, 0}, 45};
        s.render.map.photon_depth = 2; // one reflection and the floor
        s.render.map.photons = 200000;
        return s;
    }

    constexpr double cells_across = 100; // of the photon map over the floor

    TEST(validation, light_from_far_away_draws_a_nephroid)
    {
        // A paraboloid with the lamp at its focus replaces a distant lamp: its light is parallel, and it wastes none.
        const double tilt = M_PI / 4, focal = 0.4, rim = 1.6;
        auto s = mirror_cylinder(1, 1);
        const dvec3 beam(std::cos(tilt), -std::sin(tilt), 0), vertex = dvec3(0, 0.5, 0) - 5.0 * beam;
        s.paraboloids = {{vertex, vertex + rim * rim / (4 * focal) * beam, rim, 1}};
        s.point_lights = {{"lamp", vertex + focal * beam, dvec3(10)}};
        s.render.map.photon_depth = 3;
        s.render.map.photons = 400000;
        std::vector<dvec2> photons;
        for (const auto& p : traced(s)) // of the beam, and turned by the cylinder
            if (std::abs(p.direction.y - beam.y) < 1e-3 && p.direction.x < 0.98 * beam.x)
                photons.emplace_back(p.at.x, p.at.z);
        // The nephroid: a circle of radius 1/4 rolling outside one of radius 1/2 (Huygens 1690).
        const auto nephroid = [](double t) {
            return dvec2(3 * std::cos(t) - std::cos(3 * t), 3 * std::sin(t) - std::sin(3 * t)) / 4.0;
        };
        expect_ridge("nephroid", photons, nephroid, both_sides(0.35, 1.0, 20), 2 / cells_across);
    }

    TEST(validation, light_from_the_circle_draws_a_cardioid)
    {
        auto s = mirror_cylinder(1, 0.5);
        s.point_lights = {{"lamp", {-0.999, 0.5, 0}, dvec3(10)}};
        std::vector<dvec2> photons;
        for (const auto& p : traced(s))
            photons.emplace_back(p.at.x, p.at.z);
        // The cardioid: a circle of radius 1/3 rolling round one of the same size (de L'Hopital 1696).
        const auto cardioid = [](double t) {
            return dvec2(2 * std::cos(t) - std::cos(2 * t), 2 * std::sin(t) - std::sin(2 * t)) / 3.0;
        };
        expect_ridge("cardioid", photons, cardioid, both_sides(0.5, 2.1, 24), 2 / cells_across);
    }

    TEST(validation, the_ring_scene_draws_its_catacaustic)
    {
        auto s = read_scene(PHOTONGRID_SCENES "/ring.json");
        const double radius = s.cylinders[0].radius;
        const dvec3 lamp = s.point_lights[0].position;
        s.materials[0].reflectance = dvec3(0);
        s.materials[1].reflectance = dvec3(1);
        s.render = with_numbers(s.render, {});
        s.render.map.photon_depth = 2;
        s.render.map.photons = 200000;
        std::vector<dvec2> photons;
        for (const auto& p : traced(s))
            if (std::hypot(p.at.x, p.at.z) < radius) // not what the outside reflects
                photons.emplace_back(p.at.x, p.at.z);
        // A pencil meeting a mirror of radius of curvature R at angle i focuses where 1/s + 1/s' = 2 / (R cos i).
        const auto catacaustic = [&](double t) {
            const dvec2 q(radius * std::cos(t), radius * std::sin(t)), n = -q / radius, way = q - dvec2(lamp.x, lamp.z),
                                                                       d = glm::normalize(way);
            const double cosine = -glm::dot(d, n), s2 = 1 / (2 / (radius * cosine) - 1 / glm::length(way));
            return q + s2 * (d + 2 * cosine * n);
        };
        expect_ridge("ring.json", photons, catacaustic, both_sides(0.3, 0.8, 16, std::atan2(-lamp.z, -lamp.x)),
            2 * radius / cells_across);
    }

} // namespace
} // namespace photongrid::testing
