// What the biases of estimates are worth: on light whose bias is known, and on the average over maps. On the serial
// backend; the others equal it (estimators.hpp).
#include "../backends/serial_algorithms.hpp"
#include "../map/photon_sets.hpp"

#include <photongrid/estimate/knn_grid_estimate.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace photongrid::testing {
namespace {

    using glm::vec4;
    constexpr double pi = std::numbers::pi;
    using field = std::function<double(double, double)>; ///< irradiance, W/m^2, at (x, z)

    struct biased_estimate {
        double irradiance, bias;
        glm::dvec3 tilt, jump;
    };
    biased_estimate reported_by(serial_backend& b, const map_buffers<serial_backend>& map, const knn_settings& s)
    {
        const std::vector<vec4> at(1, vec4(0, 0, 0, 1)), up(1, vec4(0, 1, 0, 0));
        const auto points = b.upload(std::span<const vec4>(at)), normals = b.upload(std::span<const vec4>(up));
        const auto e = knn_grid_estimate(b, map, points, normals, s);
        const auto one = [&](const auto& buffer) { return glm::dvec4(b.download(buffer)[0]); };
        return {
            one(e.irradiance).x, one(e.biases.bias).x, glm::dvec3(one(e.biases.tilt)), glm::dvec3(one(e.biases.jump))};
    }

    /// Photons on a fine lattice around the origin, so that sums over a disc are integrals.
    class lattice {
    public:
        explicit lattice(const field& light)
        {
            constexpr int n = 301;
            constexpr double side = 2.2 / n;
            photon_set s;
            s.g = make_grid(glm::vec3(-1.1f, 0, -1.1f), glm::vec3(1.1f, 0, 1.1f), {40, 1, 40});
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const double x = (i + 0.5) * side - 1.1 + 0.31 * side, z = (j + 0.5) * side - 1.1 + 0.17 * side;
                    s.positions.emplace_back(x, 0, z, 0);
                    s.powers.emplace_back(vec4(static_cast<float>(light(x, z) * side * side)));
                }
            map_ = sorted_map(b_, upload_photons(b_, s), s.g);
        }
        biased_estimate operator()(filter_kind f, float radius)
        {
            knn_settings s{.max_radius = radius, .search = search_kind::fixed_radius, .filter = f, .biases = true};
            return reported_by(b_, map_, s);
        }

    private:
        serial_backend b_;
        map_buffers<serial_backend> map_;
    };

    /// The means of weight(rho) and rho^2 weight(rho) over the disc, by the midpoint rule.
    std::pair<double, double> means_of(const std::function<double(double)>& weight)
    {
        constexpr int n = 100000;
        double all = 0, second = 0;
        for (int i = 0; i < n; ++i) {
            const double rho = (i + 0.5) / n;
            all += weight(rho) * 2 * rho / n;
            second += weight(rho) * 2 * rho * rho * rho / n;
        }
        return {all, second};
    }

    TEST(biases, filters_have_the_second_moments_of_integration)
    {
        const std::function<double(double)> weights[] = {[](double) { return 1; }, [](double r) { return 1 - r; },
            [](double r) { return 1 - r * r; }, [](double r) { return (1 - r * r) * (1 - r * r); }};
        ASSERT_EQ(std::size(weights), filters.size());
        for (const auto& f : filters) {
            const auto [mean, second] = means_of(weights[static_cast<std::size_t>(f.kind)]);
            EXPECT_NEAR(static_cast<double>(f.norm) * mean, 1, 1e-8) << f.name;
            EXPECT_NEAR(f.mean_distance2, second / mean, 1e-7) << f.name;
        }
        EXPECT_FLOAT_EQ(detail::bias_factor(filter_kind::constant), 3);
        EXPECT_FLOAT_EQ(detail::bias_factor(filter_kind::cone), 1.8f);
        EXPECT_FLOAT_EQ(detail::bias_factor(filter_kind::epanechnikov), 2);
        EXPECT_FLOAT_EQ(detail::bias_factor(filter_kind::silverman), 1.5f);
    }

    /// A paraboloid has no derivatives but those that estimates see: what is reported is what the estimate is wrong by.
    TEST(biases, of_a_paraboloid_are_its_bias)
    {
        lattice dish([](double x, double z) { return 1 + 0.4 * x + 2 * x * x + z * z; });
        for (const auto& f : filters)
            for (const float radius : {0.5f, 1.0f}) {
                const auto e = dish(f.kind, radius);
                const double r2 = static_cast<double>(radius) * static_cast<double>(radius), laplacian = 6;
                EXPECT_NEAR(e.irradiance - 1, laplacian * r2 / 4 * static_cast<double>(f.mean_distance2), 0.006 * r2)
                    << f.name;
                EXPECT_NEAR(e.bias, e.irradiance - 1, 0.01 * r2) << f.name;
            }
    }

    /// A slope has no bias and no jump; a step has both moments that are promised, across it.
    TEST(biases, moments_distinguish_a_step_from_a_slope)
    {
        const double slope = 0.9;
        const auto s = lattice([&](double x, double) { return 2 + slope * x; })(filter_kind::silverman, 1);
        EXPECT_NEAR(s.bias, 0, 0.004);
        EXPECT_NEAR(s.tilt.x, slope / 4, 0.004);
        EXPECT_NEAR(s.jump.x, 0, 0.004);
        EXPECT_NEAR(glm::length(glm::dvec2(s.tilt.z, s.jump.z)), 0, 0.01);
        for (const double angle : {0.0, 1.0, 4.0}) {
            const double high = 1.5, low = 0.5, cosine = std::cos(angle), sine = std::sin(angle);
            const auto e = lattice([&](double x, double z) { return x * cosine + z * sine > 0 ? high : low; })(
                filter_kind::constant, 1);
            EXPECT_NEAR(e.irradiance, 1, 0.01);
            EXPECT_NEAR(e.bias, 0, 0.02) << "the filters do not see it";
            const double tilt = 2 * (high - low) / (3 * pi), jump = (high - low) / (9 * pi);
            EXPECT_NEAR(e.tilt.x, tilt * cosine, 0.006);
            EXPECT_NEAR(e.tilt.z, tilt * sine, 0.006);
            EXPECT_NEAR(e.jump.x, jump * cosine, 0.006);
            EXPECT_NEAR(e.jump.z, jump * sine, 0.006);
            EXPECT_NEAR(4.5 * pi * jump, (high - low) / 2, 1e-12);
            EXPECT_NEAR(0.75 * pi * tilt, (high - low) / 2, 1e-12);
        }
    }

    /// Photons at random where the light is a product of cosines: the means of the estimate and of its bias are what
    /// integration finds, and their noise is what is documented.
    TEST(biases, of_random_photons_are_right_on_the_average)
    {
        constexpr int maps = 600, photons = 1000;
        const double amplitude = 0.8;
        const auto light
            = [&](double x, double z) { return 1 + amplitude * std::cos(2 * pi * x) * std::cos(2 * pi * z); };
        // Its mean over a circle around the origin, less its value there.
        const auto rise
            = [&](double radius) { return amplitude * (std::cyl_bessel_j(0.0, 2 * std::sqrt(2.0) * pi * radius) - 1); };
        serial_backend b;
        struct row {
            filter_kind filter;
            double radius, noise; ///< noise of the bias over that of the estimate
            double light = 0, squares = 0, bias = 0, bias_squares = 0;
        };
        std::vector<row> rows;
        for (const double radius : {0.1, 0.2}) {
            rows.push_back({filter_kind::silverman, radius, std::sqrt(0.75 / 1.8)});
            rows.push_back({filter_kind::constant, radius, std::sqrt(3.0)});
        }
        for (int m = 0; m < maps; ++m) {
            random_source u(static_cast<std::uint64_t>(m));
            photon_set s;
            s.g = make_grid(glm::vec3(-0.5f, 0, -0.5f), glm::vec3(0.5f, 0, 0.5f), {8, 1, 8});
            while (s.positions.size() < photons) {
                const auto number = [&] { return static_cast<double>(u()); };
                const double x = number() - 0.5, z = number() - 0.5;
                if ((1 + amplitude) * number() > light(x, z))
                    continue;
                s.positions.emplace_back(x, 0, z, 0);
                s.powers.emplace_back(vec4(1.0f / photons));
            }
            const auto map = sorted_map(b, upload_photons(b, s), s.g);
            for (auto& r : rows) {
                const auto e = reported_by(b, map,
                    {.max_radius = static_cast<float>(r.radius),
                        .search = search_kind::fixed_radius,
                        .filter = r.filter,
                        .biases = true});
                r.light += e.irradiance / maps;
                r.squares += e.irradiance * e.irradiance / maps;
                r.bias += e.bias / maps;
                r.bias_squares += e.bias * e.bias / maps;
            }
        }
        std::printf(
            "| filter | radius | bias | what is reported, by integration | reported | noise | of what is reported |\n"
            "|---|---|---|---|---|---|---|\n");
        for (const auto& r : rows) {
            const bool even = r.filter == filter_kind::constant;
            const double factor = even ? 3 : 1.5, noise = std::sqrt(r.squares - r.light * r.light),
                         own = std::sqrt(r.bias_squares - r.bias * r.bias);
            const double bias = means_of([&](double rho) {
                return (even ? 1 : 3 * std::pow(1 - rho * rho, 2)) * rise(r.radius * rho);
            }).first;
            const double reported
                = means_of([&](double rho) { return factor * (2 * rho * rho - 1) * rise(r.radius * rho); }).first;
            std::printf("| %s | %.1f | %.4f | %.4f | %.4f | %.3f | %.3f |\n", detail::entry_of(r.filter).name, r.radius,
                bias, reported, r.bias, noise, own);
            EXPECT_NEAR(r.light - light(0, 0), bias, 4 * noise / std::sqrt(maps));
            EXPECT_NEAR(r.bias, reported, 4 * own / std::sqrt(maps));
            EXPECT_NEAR(reported / bias, 1, r.radius < 0.15 ? 0.06 : 0.15);
            EXPECT_LT(std::abs(bias), 0.5);
            // Variance of a sum with these weights; the number of photons of a map is given.
            const auto variance = [&](const std::function<double(double)>& weight) {
                const auto here = [&](double rho) { return light(0, 0) + rise(r.radius * rho); };
                const double mean = means_of([&](double rho) { return weight(rho) * here(rho); }).first,
                             second = means_of([&](double rho) { return std::pow(weight(rho), 2) * here(rho); }).first;
                return second / (pi * r.radius * r.radius) - mean * mean;
            };
            const double known = std::sqrt(variance([&](double rho) { return factor * (2 * rho * rho - 1); })
                / variance([&](double rho) { return even ? 1 : 3 * std::pow(1 - rho * rho, 2); }));
            EXPECT_NEAR(own / noise, known, 0.1 * known);
            EXPECT_NEAR(known, r.noise, 0.2 * r.noise); // in even light
        }
    }

} // namespace
} // namespace photongrid::testing
