// Mirrors and glass.
#pragma once

#include "reference_under_test.hpp"

namespace photongrid {
namespace {

    // --- mirrors and glass ---
    TEST(reference, glass_slab_transmits_what_fresnel_says)
    {
        scene s = empty_scene();
        s.materials[3].reflectance = dvec3(0.9);
        s.polygons = {rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 3),
            rectangle({-1, -1, -0.1}, {0, 2, 0}, {2, 0, 0}, 3)};                               // normals +z and -z
        s.rectangle_lights = {{"lamp", {-4, -4, -1}, {8, 0, 0}, {0, 8, 0}, dvec3(64 * M_PI)}}; // radiance 1, facing +z
        const double r = 0.04, t = 0.9; // ((1.5 - 1) / (1.5 + 1))^2
        auto settings = quick(8, 8, 2000);
        settings.depth = 200;
        const double all = t * t * (1 - r) * (1 - r) / (1 - t * t * r * r);
        expect_agrees(render_reference(s, looking_at({0, 0, 3}, dvec3(0)), settings), all, 0.002);
        settings.depth = 2;
        expect_agrees(render_reference(s, looking_at({0, 0, 3}, dvec3(0)), settings), t * t * (1 - r) * (1 - r), 0.002);
        settings.depth = 1;
        expect_dark(render_reference(s, looking_at({0, 0, 3}, dvec3(0)), settings));
        // At 60 degrees, without tint: Fresnel's amplitudes by tangents and sines of the two angles.
        s.materials[3].reflectance = dvec3(1);
        const double i = M_PI / 3, o = std::asin(std::sin(i) / 1.5);
        const double rs = std::pow(std::sin(i - o) / std::sin(i + o), 2),
                     rp = std::pow(std::tan(i - o) / std::tan(i + o), 2);
        settings.depth = 2;
        const double share = 0.5 * (rs + rp);
        expect_agrees(render_reference(s, looking_at({std::sin(i), 0, std::cos(i)}, dvec3(0)), settings),
            (1 - share) * (1 - share), 0.003);
    }

    /// Directional light by a pane on rough surfaces: by bins, whose pixels are not independent. What comes back from
    /// the pane is little, since they are dark.
    TEST(reference, rough_surfaces_behind_a_pane_have_the_light_that_fresnel_says)
    {
        const double cosine = 0.8, inside = std::sqrt(1 - 0.4 * 0.4), // 0.6 / 1.5
            rs = (cosine - 1.5 * inside) / (cosine + 1.5 * inside),
                     rp = (inside - 1.5 * cosine) / (inside + 1.5 * cosine), share = 0.5 * (rs * rs + rp * rp);
        for (const auto kind : {material_kind::metal, material_kind::plastic}) {
            scene s = empty_scene();
            s.materials[1] = {"plate", kind, dvec3(kind == material_kind::metal ? 0.02 : 0)};
            s.materials[1].roughness = 0.5;
            s.polygons = {rectangle({-0.3, 0, -0.3}, {0, 0, 0.6}, {0.6, 0, 0}, 1)};
            s.directional_lights = {{"sun", {0, -0.8, -0.6}, dvec3(3)}};
            const camera view{{0, 0.25, -0.45}, {0, 0, 0}, {0, 1, 0}, 20};
            auto settings = quick(8, 6, 64);
            settings.paths = 1u << 20;
            settings.bin = 0.02; // some ten paths in each
            const double bare = overall(render_reference(s, view, settings)).mean.x;
            s.boxes = {{{-0.5, 0.4, -0.2}, {1, 0, 0}, {0, 0, 1}, {0, 0.01, 0}, 3}};
            const auto behind = render_reference(s, view, settings);
            EXPECT_NEAR(overall(behind).mean.x / bare, (1 - share) / (1 + share), 0.02);
            EXPECT_GT(behind.stats.light_paths, 0u);
        }
    }

    /// Flux per ring of the floor, by the light tracer: irradiance round the ring times its area.
    std::vector<double> flux_in_rings(
        const scene& s, const reference_settings& settings, double width, std::size_t rings)
    {
        const reference::geometry shapes(s);
        reference_stats stats;
        const reference::caustic_bins bins(s, shapes, settings, {}, stats);
        std::vector<double> flux;
        for (std::size_t i = 0; i < rings; ++i) {
            double sum = 0;
            const int turns = 5040; // a multiple of most numbers of sectors, and many times the others
            for (int k = 0; k < turns; ++k) {
                const double phi = 2 * M_PI * (k + 0.5) / turns, rho = width * (static_cast<double>(i) + 0.5);
                const dvec3 p(rho * std::cos(phi), 1, rho * std::sin(phi));
                sum += bins.irradiance(shapes.nearest({p, {0, -1, 0}, reference::nothing}), {0, -1, 0}).first.x / turns;
            }
            flux.push_back(sum * M_PI * width * width * (2 * static_cast<double>(i) + 1));
        }
        return flux;
    }

    TEST(reference, glass_ball_has_the_caustic_of_snells_law)
    {
        // Lamp, ball and floor on one axis. Light through the ball by one entry and one exit, and light reflected by
        // its outside.
        const double lamp = 3, middle = 2, radius = 0.5, index = 1.5, power = 20, floor = 0, width = 0.025;
        const std::size_t rings = 40;
        scene s = empty_scene();
        s.disks = {{{0, floor, 0}, {0, 1, 0}, width * static_cast<double>(rings), white}};
        s.spheres = {{{0, middle, 0}, radius, 3}};
        s.point_lights = {{"lamp", {0, lamp, 0}, dvec3(power)}};
        auto settings = quick(1, 1, 2);
        settings.photon_depth = 3;
        settings.paths = 4000000;
        settings.bin = width;
        // The probes of flux_in_rings come from y = 1, between ball and floor.
        const auto traced = flux_in_rings(s, settings, width, rings);

        // One dimension: angle alpha off the axis; Snell by angles, Fresnel by sines and tangents.
        std::vector<double> expected(rings, 0.0);
        const double distance = lamp - middle, widest = std::asin(radius / distance);
        const int steps = 400000;
        for (int k = 0; k < steps; ++k) {
            const double alpha = widest * (k + 0.5) / steps;
            const double flux = power / 2 * std::sin(alpha) * widest / steps;
            const double i = std::asin(distance * std::sin(alpha) / radius), o = std::asin(std::sin(i) / index);
            const double rs = std::pow(std::sin(i - o) / std::sin(i + o), 2),
                         rp = std::pow(std::tan(i - o) / std::tan(i + o), 2), r = 0.5 * (rs + rp);
            // Position angle of the entry, seen from the ball's middle off the upward axis; each refraction turns the
            // ray towards the axis by i - o, and the exit lies pi - 2 o further round.
            const double entry = i - alpha, exit = entry + M_PI - 2 * o;
            const double turned = alpha - 2 * (i - o); // direction off straight down
            const double x = radius * std::sin(exit), y = middle + radius * std::cos(exit);
            const double rho = std::abs(x + (y - floor) * std::tan(turned));
            if (rho < width * static_cast<double>(rings))
                expected[static_cast<std::size_t>(rho / width)] += flux * (1 - r) * (1 - r);
            const double reflected = alpha + M_PI - 2 * i; // off straight down
            if (std::abs(reflected) < M_PI / 2) {
                const double far
                    = radius * std::sin(entry) + (middle + radius * std::cos(entry) - floor) * std::tan(reflected);
                if (far < width * static_cast<double>(rings))
                    expected[static_cast<std::size_t>(far / width)] += flux * r;
            }
        }
        double total = 0;
        for (std::size_t i = 0; i < rings; ++i) {
            total += expected[i];
            EXPECT_NEAR(traced[i], expected[i],
                5 * std::sqrt(std::max(expected[i], 20 * power / 4e6) * power / 4e6) + 1e-3 * expected[i])
                << "ring " << i;
        }
        EXPECT_GT(total, 0.1);
        EXPECT_NEAR(std::accumulate(traced.begin(), traced.end(), 0.0), total, 5 * std::sqrt(total * power / 4e6));
    }

    TEST(reference, cylinder_mirror_has_the_caustic_of_quadrature)
    {
        scene s = empty_scene();
        const double r = 1, height = 0.4, power = 10;
        const dvec3 lamp(0.6, 1.0, 0.2);
        s.polygons = {rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, white)};
        s.cylinders = {{{0, 0, 0}, {0, height, 0}, r, 2}};
        s.point_lights = {{"lamp", lamp, dvec3(power)}};
        auto settings = quick(1, 1, 2);
        settings.photon_depth = 2; // one reflection and the floor
        settings.paths = 4000000;
        const int cells = 10;
        settings.bin = 2.0 / cells;
        const reference::geometry shapes(s);
        reference_stats stats;
        const reference::caustic_bins bins(s, shapes, settings, {}, stats);
        // Midpoint rule over the inside of the cylinder.
        std::vector<double> expected(cells * cells, 0.0);
        const int around = 4000, up = 400;
        for (int i = 0; i < around; ++i)
            for (int k = 0; k < up; ++k) {
                const double phi = 2 * M_PI * (i + 0.5) / around, y = height * (k + 0.5) / up;
                const dvec3 p(r * std::cos(phi), y, r * std::sin(phi)), inward(-std::cos(phi), 0, -std::sin(phi)),
                    in = p - lamp;
                const double length = glm::length(in), cosine = -glm::dot(in, inward) / length;
                const double flux
                    = power / (4 * M_PI) * cosine / (length * length) * (2 * M_PI * r / around) * (height / up) * 0.8;
                const dvec3 out = in - 2 * glm::dot(in, inward) * inward;
                const dvec3 q = p - p.y / out.y * out;
                if (out.y < 0
                    && std::hypot(q.x, q.z) < r) // inside, so neither the ray in nor the ray out met the wall before
                    expected[static_cast<std::size_t>(
                        (std::floor((q.z + 1) * cells / 2)) * cells + std::floor((q.x + 1) * cells / 2))]
                        += flux;
            }
        double total = 0;
        for (int z = 0; z < cells; ++z)
            for (int x = 0; x < cells; ++x) {
                const dvec3 p((x + 0.5) * 2 / cells - 1, 0.5, (z + 0.5) * 2 / cells - 1);
                const reference::hit floor = shapes.nearest({{p.x, 1e-9, p.z}, {0, -1, 0}, reference::nothing});
                const double traced = bins.irradiance(floor, {0, -1, 0}).first.x * (4.0 / (cells * cells)),
                             exact = expected[static_cast<std::size_t>(z * cells + x)];
                EXPECT_EQ(bins.irradiance(floor, {0, 1, 0}).first, dvec3(0)) << "the floor's other side";
                EXPECT_NEAR(traced, exact, 5 * std::sqrt((exact + 10 * power / 4e6) * power / 4e6) + 2e-3 * exact)
                    << x << ", " << z;
                total += exact;
            }
        EXPECT_GT(total, 0.2);
    }

    TEST(reference, mirror_shows_what_stands_behind_it_mirrored)
    {
        scene s = empty_scene();
        s.disks = {{dvec3(0), {0, 0, 1}, 3, 2}};
        s.rectangle_lights
            = {{"lamp", {0.1, -0.3, 2}, {0, 0.9, 0}, {0.5, 0, 0}, dvec3(M_PI * 0.45 * 10)}}; // facing the mirror, -z
        const camera eye{{2.5, 0.1, 4}, {0.35, 0.15, -2}, {0, 1, 0}, 10};                    // past the lamp itself
        const auto in_mirror = render_reference(s, eye, quick(24, 24, 64));
        scene direct = s;
        direct.disks.clear();
        direct.rectangle_lights[0]
            = {"lamp", {0.1, -0.3, -2}, {0.5, 0, 0}, {0, 0.9, 0}, s.rectangle_lights[0].power}; // behind, facing +z
        const auto behind = render_reference(direct, eye, quick(24, 24, 64));
        int lit = 0, edge = 0;
        for (std::size_t i = 0; i < in_mirror.mean.pixels.size(); ++i) { // the same random numbers: the same eye rays
            EXPECT_NEAR(in_mirror.mean.pixels[i].x, 0.8f * behind.mean.pixels[i].x, 1e-5);
            lit += std::abs(behind.mean.pixels[i].x - 10) < 1e-4f ? 1 : 0;
            edge += behind.standard_error.pixels[i].x > 0 ? 1 : 0;
        }
        EXPECT_GT(lit, 100);
        EXPECT_GT(edge, 20);
    }

    /// z-scores of two pictures' pixels: mean square, and of the pictures' sums.
    struct comparison {
        double mean_square = 0, sum = 0;
    };
    comparison compare_by_error(const reference_picture& a, const reference_picture& b)
    {
        comparison z;
        double difference = 0, variance = 0, n = 0;
        for (std::size_t i = 0; i < a.mean.pixels.size(); ++i) {
            const double d = static_cast<double>(a.mean.pixels[i].y) - static_cast<double>(b.mean.pixels[i].y);
            const double v = std::pow(static_cast<double>(a.standard_error.pixels[i].y), 2)
                + std::pow(static_cast<double>(b.standard_error.pixels[i].y), 2);
            difference += d;
            variance += v;
            if (v > 0) {
                z.mean_square += d * d / v;
                ++n;
            }
        }
        z.mean_square /= n;
        z.sum = difference / std::sqrt(variance);
        return z;
    }

    TEST(reference, glass_of_index_one_is_not_there)
    {
        scene s = empty_scene();
        s.materials[3].index_of_refraction = 1;
        s.polygons = {rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 1)};
        s.rectangle_lights = {{"lamp", {-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, dvec3(10)}};
        const camera eye{{0, 2, 4}, {0, 0.3, 0}, {0, 1, 0}, 30};
        const auto without = render_reference(s, eye, quick(8, 8, 2000));
        s.spheres = {{{0.2, 0.6, 0}, 0.5, 3}};
        auto settings = quick(8, 8, 2000);
        settings.paths = 2000000;
        settings.bin = 0.1;
        const auto by_paths = compare_by_error(render_reference(s, eye, settings), without);
        EXPECT_LT(by_paths.mean_square, 1.7);
        EXPECT_LT(std::abs(by_paths.sum), 4);
        settings.area_light_caustics = caustics_by::bins;
        const auto by_bins = compare_by_error(render_reference(s, eye, settings), without);
        EXPECT_LT(by_bins.mean_square, 1.9);
        EXPECT_LT(std::abs(by_bins.sum), 4);
    }

    TEST(reference, caustics_by_bins_and_by_paths_agree)
    {
        // A glass ball with a grey one inside it, a mirror, and walls that reflect the caustics.
        scene s = empty_scene();
        s.polygons = {rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 1), rectangle({-2, 0, -1}, {4, 0, 0}, {0, 2, 0}, 1),
            rectangle({1, 0, -1}, {0, 0, 1}, {0, 1, 0}, 2)};
        s.spheres = {{{0, 0.6, 0}, 0.5, 3}, {{0.1, 0.5, 0}, 0.25, 1}};
        s.rectangle_lights = {{"lamp", {-0.7, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, dvec3(10)}};
        const camera eye{{0.3, 2, 4}, {0, 0.4, 0}, {0, 1, 0}, 30};
        auto settings = quick(10, 8, 8000);
        settings.paths = 3000000;
        settings.bin = 0.03;
        const auto paths = render_reference(s, eye, settings);
        settings.spp = 1000;
        settings.area_light_caustics = caustics_by::bins;
        const auto bins = render_reference(s, eye, settings);
        EXPECT_EQ(paths.stats.light_paths, 0u);
        EXPECT_EQ(bins.stats.light_paths, 3000000u);
        const auto z = compare_by_error(bins, paths);
        EXPECT_LT(z.mean_square, 1.8) << "bins " << overall(bins).mean.x << ", paths " << overall(paths).mean.x;
        EXPECT_LT(std::abs(z.sum), 4) << "bins " << overall(bins).mean.x << ", paths " << overall(paths).mean.x;
    }

} // namespace
} // namespace photongrid
