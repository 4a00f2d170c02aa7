// The reference renderer against analytic answers: form factors, integrating spheres, Fresnel's and Snell's equations,
// quadrature, and roots found by brute force in long double.
#include <photongrid/reference.hpp>

#include "image_file.hpp"
#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <numeric>
#include <random>

#include <sys/wait.h>
#include <unistd.h>

namespace photongrid {
namespace {

    const std::uint32_t white = 0;

    /// A scene with the materials that the tests use: white (reflectance 1), grey, mirror, glass.
    scene empty_scene()
    {
        scene s;
        s.name = "test";
        s.materials = {{"white", material_kind::lambertian, dvec3(1)}, {"grey", material_kind::lambertian, dvec3(0.5)},
            {"mirror", material_kind::mirror, dvec3(0.8)}, {"glass", material_kind::glass, dvec3(1), 1.5}};
        return s;
    }
    polygon rectangle(dvec3 corner, dvec3 u, dvec3 v, std::uint32_t material)
    {
        return {{corner, corner + u, corner + u + v, corner + v}, material};
    }

    /// A camera that sees next to nothing but `point`.
    camera looking_at(dvec3 from, dvec3 point) { return {from, point, {0.3, 0.8, 0.5}, 0.001}; }

    reference_settings quick(std::uint32_t width, std::uint32_t height, std::uint32_t spp)
    {
        reference_settings r;
        r.width = width;
        r.height = height;
        r.spp = spp;
        r.threads = 2;
        return r;
    }

    struct mean_and_error {
        dvec3 mean{0}, error{0};
    };
    /// All pixels together, as estimates of one quantity.
    mean_and_error overall(const reference_picture& p)
    {
        mean_and_error m;
        const double n = static_cast<double>(p.mean.pixels.size());
        for (std::size_t i = 0; i < p.mean.pixels.size(); ++i) {
            m.mean += dvec3(p.mean.pixels[i]) / n;
            m.error += dvec3(p.standard_error.pixels[i]) * dvec3(p.standard_error.pixels[i]) / (n * n);
        }
        m.error = glm::sqrt(m.error);
        return m;
    }
    /// Four standard errors, and the rounding of float pictures.
    void expect_agrees(const reference_picture& p, double expected, double largest_error)
    {
        const auto m = overall(p);
        EXPECT_LT(m.error.x, largest_error * expected) << "too noisy to tell";
        EXPECT_NEAR(m.mean.x, expected, 4 * m.error.x + 2e-7 * expected);
        EXPECT_EQ(p.stats.invalid_samples, 0u);
    }

    void expect_dark(const reference_picture& p)
    {
        for (const auto& pixel : p.mean.pixels)
            EXPECT_EQ(pixel, glm::vec3(0));
    }

    // --- light that is known in closed form ---
    TEST(reference, integrating_sphere_has_the_irradiance_of_a_geometric_series)
    {
        for (const double rho : {0.3, 0.8}) {
            auto s = testing::integrating_sphere(dvec3(rho));
            s.point_lights[0].position = dvec3(0.3, -0.2, 0.1); // off the middle: only direct light is then uneven
            auto settings = quick(8, 6, 400);
            settings.photon_depth = 200;
            const auto deep = render_reference(s, s.camera, settings);
            settings.photon_depth = 1;
            const auto direct = render_reference(s, s.camera, settings);
            settings.photon_depth = 3;
            const auto three = render_reference(s, s.camera, settings);
            // Indirect irradiance Phi rho / (4 pi R^2 (1 - rho)) is even; Phi / (4 pi R^2) is pi here.
            const double mean_direct = overall(direct).mean.x;
            expect_agrees(deep, mean_direct + rho * rho / (1 - rho), 0.01);
            expect_agrees(three, mean_direct + rho * (rho + rho * rho), 0.01);
        }
        const auto s = testing::integrating_sphere(dvec3(0.5));
        auto settings = quick(8, 6, 100);
        settings.photon_depth = 200;
        expect_agrees(render_reference(s, s.camera, settings), 1, 0.01); // rho / (1 - rho)
    }

    TEST(reference, point_light_falls_off_with_the_square_and_the_cosine)
    {
        scene s = empty_scene();
        s.disks = {{dvec3(0), {0, 1, 0}, 5, white}};
        s.point_lights = {{"a", {1, 2, 0}, dvec3(7)}, {"b", {0, 1, 3}, dvec3(3)}};
        auto settings = quick(4, 4, 4000);
        settings.photon_depth = 1;
        const double expected = 7 / (4 * M_PI) * 2 / std::pow(5, 1.5) + 3 / (4 * M_PI) * 1 / std::pow(10, 1.5);
        expect_agrees(render_reference(s, looking_at({0, 3, -1}, dvec3(0)), settings), expected / M_PI, 0.005);
        s.disks.push_back({{0.5, 1, 0}, {0, 1, 0}, 0.1, white}); // hides lamp a
        expect_agrees(render_reference(s, looking_at({0, 3, -1}, dvec3(0)), settings),
            3 / (4 * M_PI) / std::pow(10, 1.5) / M_PI, 0.02);
        expect_dark(render_reference(s, looking_at({0, -3, -1}, dvec3(0)), settings)); // the other side is dark
    }

    TEST(reference, rectangle_light_has_the_form_factors_of_the_textbook)
    {
        // Differential area under the corner of a rectangle a x b at distance c, parallel and at right angles
        // (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3 and B-4).
        const double a = 1.2, b = 0.7, c = 0.5, power = 9, radiance = power / (M_PI * a * b);
        const auto parallel = [](double x, double y) {
            const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
            return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * M_PI);
        };
        const auto right_angles = [](double x, double y) {
            return (std::atan(1 / y) - y / std::hypot(x, y) * std::atan(1 / std::hypot(x, y))) / (2 * M_PI);
        };
        scene s = empty_scene();
        s.disks = {{dvec3(0), {0, 1, 0}, 0.2, white}};
        s.rectangle_lights = {{"ceiling", {0, c, 0}, {a, 0, 0}, {0, 0, b}, dvec3(power)}}; // u x v = -y: facing down
        expect_agrees(render_reference(s, looking_at({-1, 0.4, 0}, dvec3(0)), quick(8, 8, 2000)),
            radiance * parallel(a / c, b / c), 0.003);
        // Upright at distance c, b along the edge, a up: B-4 with X = a / b, Y = c / b.
        s.rectangle_lights = {{"wall", {c, 0, 0}, {0, 0, b}, {0, a, 0}, dvec3(power)}}; // u x v = -x
        expect_agrees(render_reference(s, looking_at({-1, 0.4, 0}, dvec3(0)), quick(8, 8, 2000)),
            radiance * right_angles(a / b, c / b), 0.003);
        s.rectangle_lights = {{"wall", {c, 0, 0}, {0, a, 0}, {0, 0, b}, dvec3(power)}}; // its back
        expect_dark(render_reference(s, looking_at({-1, 0.4, 0}, dvec3(0)), quick(2, 2, 100)));
        // Seen itself it shows its radiance, in front only.
        expect_agrees(render_reference(s, looking_at({2, 0.5, 0.3}, {c, 0.5, 0.3}), quick(2, 2, 4)), radiance, 1e-6);
        expect_dark(render_reference(s, looking_at({-1, 0.5, 0.3}, {c, 0.5, 0.3}), quick(2, 2, 4)));
    }

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
                             wanted = expected[static_cast<std::size_t>(z * cells + x)];
                EXPECT_EQ(bins.irradiance(floor, {0, 1, 0}).first, dvec3(0)) << "the floor's other side";
                EXPECT_NEAR(traced, wanted, 5 * std::sqrt((wanted + 10 * power / 4e6) * power / 4e6) + 2e-3 * wanted)
                    << x << ", " << z;
                total += wanted;
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
    struct agreement {
        double mean_square = 0, sum = 0;
    };
    agreement compare_by_error(const reference_picture& a, const reference_picture& b)
    {
        agreement z;
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

    // --- rays and shapes ---
    using real = long double;
    using rvec = glm::vec<3, real>;

    /// Signed value of a shape's equation at p (scaled to metres), and whether p lies in the shape's extent.
    struct equation {
        std::function<real(const rvec&)> value;
        std::function<bool(const rvec&)> inside;
        real reach; ///< all of it lies within this distance of the origin
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
            const real middle = -glm::dot(rvec(o), rvec(d)), first = std::max<real>(0, middle - e.reach),
                       last = middle + e.reach;
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

    // --- bins ---
    template <class Bins>
    double whole_area(const Bins& b)
    {
        double sum = 0;
        for (std::uint32_t i = 0; i < b.size(); ++i)
            sum += b.area(i);
        return sum;
    }

    TEST(reference, bins_cover_surfaces_exactly)
    {
        using reference::plane_bins;
        using reference::ring_bins;
        const dvec3 from(0.1, 0.2, 0.3), to(0.5, -0.4, 1.2);
        const double h = glm::length(to - from), r = 0.7;
        for (const double size : {3.0, 0.2, 0.013}) {
            EXPECT_NEAR(whole_area(ring_bins(sphere{from, r, 0}, size)), 4 * M_PI * r * r, 1e-11);
            EXPECT_NEAR(whole_area(ring_bins(disk{from, to, r, 0}, size)), M_PI * r * r, 1e-11);
            EXPECT_NEAR(whole_area(ring_bins(cylinder{from, to, r, 0}, size)), 2 * M_PI * r * h, 1e-11);
            EXPECT_NEAR(whole_area(ring_bins(cone{from, to, r, 0}, size)), M_PI * r * std::hypot(r, h), 1e-11);
            EXPECT_NEAR(whole_area(ring_bins(paraboloid{from, to, r, 0}, size)),
                M_PI * r / (6 * h * h) * (std::pow(r * r + 4 * h * h, 1.5) - r * r * r), 1e-11);
            for (std::size_t corners = 3; corners < 9; ++corners) {
                polygon p;
                for (std::size_t i = 0; i < corners; ++i) {
                    const double phi = 2 * M_PI * (static_cast<double>(i) + 0.3 * std::sin(static_cast<double>(i)))
                        / static_cast<double>(corners);
                    p.vertices.push_back(
                        from + std::cos(phi) * dvec3(1, 0.2, 0) + std::sin(phi) * dvec3(0.1, -0.3, 1.4));
                }
                EXPECT_NEAR(whole_area(plane_bins(p, size)), glm::length(area_vector(p)), 1e-11);
            }
        }
        EXPECT_NEAR(whole_area(ring_bins(paraboloid{from, from + dvec3(0, 1e-9, 0), r, 0}, 0.1)), M_PI * r * r,
            1e-11); // nearly flat
    }

    TEST(reference, points_spread_evenly_fill_bins_by_area)
    {
        // Each bin's share of evenly spread points is its share of the area: chi-squared, with points made shape by
        // shape.
        std::mt19937 random(5);
        std::uniform_real_distribution<double> unit;
        const auto expect_even = [&](const char* name, const auto& bins, auto point) {
            const int n = 200000;
            std::vector<int> counts(bins.size(), 0);
            for (int i = 0; i < n; ++i)
                ++counts[bins.at(point())];
            const double total = whole_area(bins);
            double chi2 = 0, degrees = -1;
            for (std::uint32_t b = 0; b < bins.size(); ++b) {
                const double expected = n * bins.area(b) / total;
                if (expected == 0) {
                    EXPECT_EQ(counts[b], 0) << name;
                    continue;
                }
                chi2 += (counts[b] - expected) * (counts[b] - expected) / expected;
                ++degrees;
            }
            EXPECT_GT(degrees, 20) << name;
            EXPECT_LT(std::abs(chi2 - degrees), 5 * std::sqrt(2 * degrees)) << name;
        };
        const auto round_z = [&](double radius, double z) {
            const double phi = 2 * M_PI * unit(random);
            return dvec3(radius * std::cos(phi), radius * std::sin(phi), z);
        };
        expect_even("sphere", reference::ring_bins(sphere{{0, 0, 0}, 1, 0}, 0.2), [&] {
            const double z = 2 * unit(random) - 1;
            return round_z(std::sqrt(1 - z * z), z);
        });
        expect_even("disk", reference::ring_bins(disk{{0, 0, 0}, {0, 0, 1}, 1, 0}, 0.1),
            [&] { return round_z(std::sqrt(unit(random)), 0); });
        expect_even("cylinder", reference::ring_bins(cylinder{{0, 0, 0}, {0, 0, 2}, 1, 0}, 0.2),
            [&] { return round_z(1, 2 * unit(random)); });
        expect_even("cone", reference::ring_bins(cone{{0, 0, 0}, {0, 0, 2}, 1, 0}, 0.1), [&] {
            const double x = std::sqrt(unit(random));
            return round_z(x, 2 * (1 - x));
        });
        expect_even("paraboloid", reference::ring_bins(paraboloid{{0, 0, 0}, {0, 0, 2}, 1, 0}, 0.1), [&] {
            for (;;) { // rejection by the area element rho sqrt(1 + 16 rho^2)
                const double rho = unit(random);
                if (unit(random) * std::sqrt(17.0) < rho * std::sqrt(1 + 16 * rho * rho))
                    return round_z(rho, 2 * rho * rho);
            }
        });
        const polygon triangle{{{0, 0, 0}, {1, 0.1, 0.4}, {0.2, 0.9, 0.1}}, 0};
        expect_even("triangle", reference::plane_bins(triangle, 0.07), [&] {
            double a = unit(random), b = unit(random);
            if (a + b > 1) {
                a = 1 - a;
                b = 1 - b;
            }
            return a * triangle.vertices[1] + b * triangle.vertices[2];
        });
    }

    TEST(reference, bins_that_are_too_many_are_refused)
    {
        EXPECT_THROW(reference::ring_bins(sphere{{0, 0, 0}, 1, 0}, 1e-9), std::invalid_argument);
        EXPECT_THROW(reference::ring_bins(paraboloid{{0, 0, 0}, {0, 0, 1e6}, 1, 0}, 1e-3), std::invalid_argument);
        EXPECT_THROW(
            reference::plane_bins(rectangle({0, 0, 0}, {1e9, 0, 0}, {0, 1e9, 0}, 0), 1e-3), std::invalid_argument);
    }

    // --- errors, seeds, threads ---
    bool same_bytes(const image& a, const image& b)
    {
        return a.pixels.size() == b.pixels.size()
            && std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
    }

    TEST(reference, same_seed_same_bytes_on_any_number_of_threads)
    {
        const auto s = testing::all_shapes();
        auto settings = quick(24, 16, 16);
        settings.paths = 100000;
        settings.threads = 1;
        const auto one = render_reference(s, s.camera, settings);
        for (const std::uint32_t threads : {2u, 3u}) {
            settings.threads = threads;
            const auto more = render_reference(s, s.camera, settings);
            EXPECT_TRUE(same_bytes(one.mean, more.mean)) << threads;
            EXPECT_TRUE(same_bytes(one.standard_error, more.standard_error)) << threads;
        }
        EXPECT_GT(one.stats.caustic_hits, 0u);
        settings.seed = 2;
        EXPECT_FALSE(same_bytes(one.mean, render_reference(s, s.camera, settings).mean));
    }

    void expect_honest_errors(const scene& s, reference_settings settings)
    {
        const int seeds = 40;
        std::vector<reference_picture> pictures;
        for (int i = 0; i < seeds; ++i) {
            settings.seed = static_cast<std::uint64_t>(100 + i);
            pictures.push_back(render_reference(s, s.camera, settings));
        }
        double spread = 0, said = 0;
        for (std::size_t p = 0; p < pictures[0].mean.pixels.size(); ++p) {
            double mean = 0, squares = 0;
            for (const auto& x : pictures)
                mean += static_cast<double>(x.mean.pixels[p].y) / seeds;
            for (const auto& x : pictures) {
                squares += std::pow(static_cast<double>(x.mean.pixels[p].y) - mean, 2);
                said += std::pow(static_cast<double>(x.standard_error.pixels[p].y), 2) / seeds;
            }
            spread += squares / (seeds - 1);
        }
        EXPECT_NEAR(std::sqrt(said / spread), 1, 0.15);
    }

    TEST(reference, standard_error_is_the_spread_of_seeds)
    {
        auto s = testing::small_cornell();
        auto settings = quick(8, 8, 32);
        s.materials[4].kind = s.materials[3].kind
            = material_kind::lambertian; // rare bright caustics by paths have a spread that 40 seeds do not show
        expect_honest_errors(s, settings);
        // With bins, whose errors all samples of a pixel share: a dark floor with a caustic and little else.
        scene c = empty_scene();
        c.polygons = {rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 1)};
        c.spheres = {{{0, 0.5, 0}, 0.4, 3}};
        c.point_lights = {{"lamp", {0, 2, 0}, dvec3(10)}};
        c.camera = {{0, 1.2, 1.2}, {0, 0, 0.1}, {0, 1, 0}, 15};
        settings = quick(8, 8, 64);
        settings.paths = 20000;
        settings.bin = 0.05;
        expect_honest_errors(c, settings);
    }

    TEST(reference, cancelling_and_mistakes_throw)
    {
        const auto s = testing::all_shapes();
        auto settings = quick(24, 16, 1000);
        settings.paths = 1000000;
        render_observer observer;
        int calls = 0;
        observer.cancelled = [&] { return ++calls > 3; };
        EXPECT_THROW(render_reference(s, s.camera, settings, observer), render_cancelled);
        observer.cancelled = {};
        double last = 0;
        observer.progress = [&](std::string_view stage, double fraction) {
            last = fraction;
            if (stage == "eye_paths")
                throw std::runtime_error("from the observer");
        };
        EXPECT_THROW(render_reference(s, s.camera, settings, observer), std::runtime_error);
        settings.spp = 1;
        EXPECT_THROW(render_reference(s, s.camera, settings), std::invalid_argument);
        settings = quick(4, 4, 4);
        settings.bin = -1;
        EXPECT_THROW(render_reference(s, s.camera, settings), std::invalid_argument);
        settings.bin = 1e-9;
        EXPECT_THROW(render_reference(s, s.camera, settings), std::invalid_argument);
    }

    TEST(reference, program_writes_mean_and_error)
    {
        namespace fs = std::filesystem;
        const fs::path folder = fs::temp_directory_path() / ("photongrid_reference_" + std::to_string(::getpid()));
        fs::create_directories(folder);
        const auto run = [&](const std::string& arguments) {
            const int status = std::system(("cd " + folder.string() + " && " + PHOTONGRID_PROGRAM + " reference "
                + PHOTONGRID_SCENES "/ring.json " + arguments + " >out 2>err")
                                               .c_str());
            return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        };
        EXPECT_EQ(run("-o a.exr --error e.pfm --size 16x12 --spp 16 --paths 20000 --seed 3 --stats s.json"), 0);
        const auto mean = read_image((folder / "a.exr").string()), error = read_image((folder / "e.pfm").string());
        const auto s = reference_settings_for(render_settings{.width = 16, .height = 12, .seed = 3});
        EXPECT_EQ(mean.width, s.width);
        EXPECT_EQ(error.height, s.height);
        EXPECT_GT(fs::file_size(folder / "s.json"), 100u);
        EXPECT_EQ(run("-o b.exr --size 16x12 --spp 16 --paths 20000 --seed 3 --threads 3"), 0);
        EXPECT_TRUE(same_bytes(mean, read_image((folder / "b.exr").string())));
        EXPECT_EQ(run("--spp 16"), 2);
        EXPECT_EQ(run("-o c.exr --spp 1"), 2);
        EXPECT_EQ(run("-o c.exr --bin 0"), 2);
        EXPECT_EQ(run("-o no/such/folder.exr"), 5);
        EXPECT_EQ(run("-o c.txt"), 5);
        EXPECT_FALSE(fs::exists(folder / "c.exr"));
        fs::remove_all(folder);
    }

} // namespace
} // namespace photongrid
