// A glass ball's caustic against ray density.
#pragma once

#include "../trace/mesh_sets.hpp"
#include "landed_photons.hpp"

namespace photongrid::testing {
namespace {

    // --- glass ball
    // -------------------------------------------------------------------------------------------------------

    /// Where light off the axis at an angle comes to the floor, and with which share of its power.
    struct glass_path {
        double rho = 0, weight = 0;
        bool arrives = false;
    };

    /// Lamp, ball and floor on one axis, middle of the ball at the origin of heights `lamp` and -`floor`. Light
    /// reflected `order` times: 0 by the outside, n >= 1 refracted in, reflected n - 1 times inside and refracted out.
    glass_path through_ball(double alpha, double lamp, double floor, double radius, double index, int order)
    {
        // In angles: i and o of incidence and refraction; by symmetry they are the same at every meeting with the
        // surface.
        const double i = std::asin(std::min(1.0, lamp * std::sin(alpha) / radius)), o = std::asin(std::sin(i) / index);
        const double rs = std::pow(std::sin(i - o) / std::sin(i + o), 2),
                     rp = std::pow(std::tan(i - o) / std::tan(i + o), 2), r = 0.5 * (rs + rp);
        const double entry = i - alpha;    // position angle off the upward axis
        double place = entry, heading = 0; // heading off straight down, towards growing x
        glass_path out;
        if (order == 0) {
            heading = alpha + M_PI - 2 * i;
            out.weight = r;
        } else {
            place = entry + order * (M_PI - 2 * o);
            heading = alpha - 2 * (i - o) - (order - 1) * (M_PI - 2 * o);
            out.weight = (1 - r) * (1 - r) * std::pow(r, order - 1);
        }
        const dvec2 at(radius * std::sin(place), radius * std::cos(place)), d(std::sin(heading), -std::cos(heading));
        out.arrives = d.y < -1e-9;
        if (out.arrives)
            out.rho = std::abs(at.x + (at.y + floor) / -d.y * d.x);
        return out;
    }

    /// A point light, a glass ball and a black floor on one axis, and the irradiance of the floor by ray density: power
    /// spread over rings of the floor, by angle at the lamp and number of reflections.
    class ball_on_axis {
    public:
        ball_on_axis()
        {
            const int steps = 100000, orders = 24;
            const double widest = std::asin(radius / lamp);
            for (int order = 0; order < orders; ++order)
                for (int n = 0; n < steps; ++n) {
                    const double alpha = (n + 0.5) / steps * widest;
                    const auto g = through_ball(alpha, lamp, middle, radius, index, order);
                    if (!g.arrives || g.rho >= width * static_cast<double>(rings_.size()))
                        continue;
                    rings_[static_cast<std::size_t>(g.rho / width)]
                        += power / 2 * std::sin(alpha) * widest / steps * g.weight;
                    if (order == 1 && alpha < 0.9 * widest)
                        fold_ = std::max(fold_, g.rho);
                }
        }

        scene as_scene() const
        {
            scene s;
            s.name = "ball_on_axis";
            s.materials
                = {{"black", material_kind::lambertian, dvec3(0)}, {"glass", material_kind::glass, dvec3(1), index}};
            s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
            s.spheres = {{{0, middle, 0}, radius, 1}};
            s.point_lights = {{"lamp", {0, middle + lamp, 0}, dvec3(power)}};
            s.camera = {{0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 45};
            s.render = {.map = {.photons = 150000, .grid = {200, 1, 200}}, .estimate = {.k = 200, .max_radius = 0.5}};
            return s;
        }
        /// The same with a ball of triangles that has the sphere's normals. Its corners are outside of the sphere, the
        /// middles of its triangles inside.
        scene as_scene_of_triangles(uint triangles) const
        {
            auto s = as_scene();
            s.spheres.clear();
            const uint rings = rings_of(triangles);
            const double size = radius / std::cbrt(volume_of(smooth_ball(rings)) / (4.0 / 3 * M_PI));
            s.meshes = {{"", std::make_shared<const mesh>(smooth_ball(rings)), glm::dmat3(size), {0, middle, 0}, 1}};
            return s;
        }
        /// Where the main caustic ends, m off the axis: its radius has a maximum over angles.
        double fold() const { return fold_; }
        /// Irradiance at `rho` off the axis, over 1 mm either side.
        double density(double rho) const
        {
            const auto first = static_cast<std::size_t>((rho - 1e-3) / width),
                       past = static_cast<std::size_t>((rho + 1e-3) / width);
            const double inner = static_cast<double>(first) * width, outer = static_cast<double>(past) * width;
            return std::accumulate(rings_.begin() + static_cast<std::ptrdiff_t>(first),
                       rings_.begin() + static_cast<std::ptrdiff_t>(past), 0.0)
                / (M_PI * (outer * outer - inner * inner));
        }
        /// The mean over a disc of radius r about a point at `rho`: each ring's share that lies inside.
        double disc_mean(double rho, double r) const
        {
            double total = 0; // W
            for (std::size_t i = 0; i < rings_.size(); ++i) {
                const double ring = width * (static_cast<double>(i) + 0.5),
                             c = (ring * ring + rho * rho - r * r) / (2 * ring * rho);
                total += c >= 1 ? 0 : c <= -1 ? rings_[i] : rings_[i] * std::acos(c) / M_PI;
            }
            return total / (M_PI * r * r);
        }

    private:
        static double volume_of(const mesh& m)
        {
            double v = 0;
            for (std::size_t t = 0; t < m.triangles.size(); ++t) {
                const auto c = corners_of(m, t);
                v += glm::dot(dvec3(c[0]), glm::cross(dvec3(c[1]), dvec3(c[2]))) / 6;
            }
            return v;
        }

        static constexpr double radius = 0.3, middle = 0.4, lamp = 0.9, index = 1.5, power = 10;
        static constexpr double width = 2.5e-4;                      ///< m, of a ring
        std::vector<double> rings_ = std::vector<double>(4000, 0.0); ///< W
        double fold_ = 0;
    };

    constexpr int points_around = 12;

    /// Estimates at points on circles about the axis, points_around on each.
    struct ring_estimates {
        std::vector<vec4> irradiance, errors;
    };
    ring_estimates estimates_on_circles(const scene& s, const std::vector<double>& radii)
    {
        serial_backend b;
        const auto device = upload_scene(b, s);
        auto settings = s.render;
        settings.map.emission = photon_emission::power; // photons of equal power, whose noise is known
        auto t = trace_photons(b, device, settings);
        const auto map
            = sorted_map(b, std::move(t.photons), make_grid(device.layout.low, device.layout.high, s.render.map.grid));
        std::vector<dvec3> points;
        for (const double r : radii)
            for (int n = 0; n < points_around; ++n)
                points.emplace_back(
                    r * std::cos(2 * M_PI * n / points_around + r), 0, r * std::sin(2 * M_PI * n / points_around + r));
        const auto where = recentred(points, device.layout.center);
        const auto estimates = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(where)),
            {.k = s.render.estimate.k, .max_radius = static_cast<float>(s.render.estimate.max_radius), .errors = true});
        return {b.download(estimates.irradiance), b.download(estimates.standard_error)};
    }

    /// `most_chi2`: the largest chi^2 a point.
    void expect_profile(const ball_on_axis& ball, const scene& s, double most_chi2)
    {
        std::vector<double> radii;
        for (double r = 0.02; r < 0.5; r += r < 0.24 ? 0.02 : 0.05)
            radii.push_back(r);
        const auto [irradiance, errors] = estimates_on_circles(s, radii);

        std::printf("\nglass ball: light refracted twice folds at %.4f m\n| rho, m | ray density, W/m^2 | photon map | "
                    "standard error | mean over the discs searched |\n|---|---|---|---|---|\n",
            ball.fold());
        double chi2 = 0, ratio_sum = 0;
        int compared = 0;
        for (std::size_t i = 0; i < radii.size(); ++i) {
            double mean = 0, variance = 0, discs = 0, largest = 0;
            for (int n = 0; n < points_around; ++n) {
                const std::size_t q = i * points_around + static_cast<std::size_t>(n);
                const double r = std::sqrt(static_cast<double>(irradiance[q].w)),
                             e = static_cast<double>(irradiance[q].x), known = ball.disc_mean(radii[i], r);
                largest = std::max(largest, r);
                mean += e / points_around;
                discs += known / points_around;
                variance += std::pow(static_cast<double>(errors[q].x) / points_around, 2);
                // Given where k photons end, those before it lie anywhere in the disc: estimate over the disc's mean is
                // 1 on average for any density, with relative variance 1 / (k - 2).
                ratio_sum += e / known;
                chi2 += std::pow((e - known) / (known / std::sqrt(s.render.estimate.k - 2.0)), 2);
                ++compared;
            }
            // Discs round the same circle overlap near the axis, and then their errors do not average out.
            const double se = std::sqrt(variance)
                * std::sqrt(std::max(1.0, points_around * M_PI * largest * largest / (4 * M_PI * radii[i] * largest)));
            const double known = ball.density(radii[i]);
            std::printf("| %.2f | %.4f | %.4f | %.4f | %.4f |\n", radii[i], known, mean, se, discs);
            EXPECT_NEAR(mean, discs, 5 * se) << "rho " << radii[i];
            if (std::abs(radii[i] - ball.fold()) > 5 * largest
                && radii[i] > largest) { // the density is smooth over the disc
                EXPECT_NEAR(mean, known, 5 * se + 0.02 * known) << "rho " << radii[i];
            }
        }
        std::printf("estimate over known: %.4f on average, chi^2 per point %.2f, %d points\n", ratio_sum / compared,
            chi2 / compared, compared);
        EXPECT_NEAR(ratio_sum / compared, 1, 0.01);
        EXPECT_LT(chi2 / compared, most_chi2);
    }

    TEST(validation, a_glass_balls_caustic_has_the_profile_of_ray_density)
    {
        const ball_on_axis ball;
        expect_profile(ball, ball.as_scene(), 1.5);
    }

    TEST(validation, a_glass_ball_of_triangles_has_it_too)
    {
        const ball_on_axis ball;
        expect_profile(ball, ball.as_scene_of_triangles(20'000), 1.3);
    }

} // namespace
} // namespace photongrid::testing
