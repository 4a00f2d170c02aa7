// One diffuse bounce against its form factor.
#pragma once

#include "landed_photons.hpp"

namespace photongrid::testing {
namespace {

    // --- one diffuse bounce
    // -----------------------------------------------------------------------------------------------

    /// Two facing discs. A point lamp just under the middle of the upper, black one lights the lower one, whose light
    /// comes back: all photons stored are of that one bounce.
    struct facing_discs {
        double height = 0.5, lower = 1, upper = 0.8, power = 20;
        dvec3 reflectance{0.8, 0.5, 0.2};

        scene made() const
        {
            scene s;
            s.name = "facing_discs";
            s.materials
                = {{"lower", material_kind::lambertian, reflectance}, {"upper", material_kind::lambertian, dvec3(0)}};
            s.disks = {{{0, 0, 0}, {0, 1, 0}, lower, 0}, {{0, height * (1 + 1e-4), 0}, {0, -1, 0}, upper, 1}};
            s.point_lights = {{"lamp", {0, height, 0}, dvec3(power)}};
            s.camera = {{0, 0.2, -3}, {0, 0.2, 0}, {0, 1, 0}, 45};
            s.render = {.map = {.photon_depth = 2, .grid = {64, 1, 64}}, .estimate = {.max_radius = 1}};
            return s;
        }
        /// At the middle of the upper disc, for reflectance 1: direct light is power / (4 pi) h / (h^2 + u)^(3/2) at
        /// distance sqrt(u) from the axis, and the form factor of the ring there h^2 / (h^2 + u)^2 du; their product
        /// integrates in closed form.
        double on_axis() const
        {
            const double h = height;
            return power * h * h * h / (10 * M_PI) * (std::pow(h, -5) - std::pow(h * h + lower * lower, -2.5));
        }
        /// At a distance from the axis: midpoint rule over the lower disc.
        double off_axis(double rho, int rings = 800, int around = 360) const
        {
            double sum = 0;
            const double h = height;
            for (int i = 0; i < rings; ++i) {
                const double r = lower * (i + 0.5) / rings,
                             direct = power / (4 * M_PI) * h / std::pow(h * h + r * r, 1.5);
                for (int j = 0; j < around; ++j) {
                    const double d2 = h * h + r * r + rho * rho - 2 * r * rho * std::cos(2 * M_PI * (j + 0.5) / around);
                    sum += direct / M_PI * h * h / (d2 * d2) * r * (lower / rings) * (2 * M_PI / around);
                }
            }
            return sum;
        }
    };

    /// Irradiance (rgb) and its squared radius at points of the upper disc.
    std::vector<vec4> estimates_on_upper(
        const facing_discs& f, const std::vector<dvec3>& points, uint photons, uint k, uint seed)
    {
        auto s = f.made();
        s.render.map.photons = photons;
        s.render.seed = seed;
        serial_backend b;
        const auto device = upload_scene(b, s);
        auto t = trace_photons(b, device, s.render);
        const auto map
            = sorted_map(b, std::move(t.photons), make_grid(device.layout.low, device.layout.high, s.render.map.grid));
        const auto where = recentred(points, device.layout.center);
        return b.download(
            knn_grid_estimate(b, map, b.upload(std::span<const vec4>(where)), {.k = k, .max_radius = 1}).irradiance);
    }

    std::vector<dvec3> circles(const facing_discs& f, const std::vector<double>& radii, int around)
    {
        std::vector<dvec3> points;
        for (const double r : radii)
            for (int n = 0; n < around; ++n)
                points.emplace_back(r * std::cos(2 * M_PI * (n + 0.3 * r) / around), f.height * (1 + 1e-4),
                    r * std::sin(2 * M_PI * (n + 0.3 * r) / around));
        return points;
    }

    TEST(validation, light_of_one_diffuse_bounce_has_its_form_factor)
    {
        const facing_discs f;
        EXPECT_NEAR(f.off_axis(0), f.on_axis(), 1e-5 * f.on_axis());
        const std::vector<double> radii = {0, 0.15, 0.3, 0.45, 0.6};
        const int around = 16;
        const uint k = 300;
        double ratio = 0; // over all points
        int count = 0;
        const auto e = estimates_on_upper(f, circles(f, radii, around), 300000, k, 1);
        for (std::size_t i = 0; i < radii.size(); ++i) {
            const int n = i == 0 ? 1 : around;
            const double known = i == 0 ? f.on_axis() : f.off_axis(radii[i]);
            dvec3 mean(0);
            for (int j = 0; j < n; ++j)
                mean += dvec3(e[i * around + static_cast<std::size_t>(j)]) / static_cast<double>(n);
            std::printf(
                "facing discs, %.2f m off the axis: known %.4f W/m^2 x reflectance, photon map %.4f %.4f %.4f\n",
                radii[i], known, mean.x / f.reflectance.x, mean.y / f.reflectance.y, mean.z / f.reflectance.z);
            for (int c = 0; c < 3; ++c) // 0.2 % for the curve of the profile over a disc
                EXPECT_NEAR(
                    mean[c] / f.reflectance[c], known, (5 / std::sqrt(static_cast<double>(k) * n) + 0.002) * known)
                    << radii[i] << ", channel " << c;
            ratio += n * mean.x / f.reflectance.x / known;
            count += n;
        }
        EXPECT_NEAR(ratio / count, 1, 4 / std::sqrt(static_cast<double>(k) * count) + 0.002);
    }

} // namespace
} // namespace photongrid::testing
