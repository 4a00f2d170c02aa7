// Convergence to the reference.
#pragma once

#include "../backends/serial_picture.hpp"
#include "form_factor_tests.hpp"
#include "landed_photons.hpp"

namespace photongrid::testing {
namespace {

    // --- convergence
    // ------------------------------------------------------------------------------------------------------

    /// One row of a convergence table: means over points of squared errors relative to the known value.
    struct convergence_row {
        double photons = 0, k = 0, bias2 = 0, variance = 0;
        double total() const { return bias2 + variance; }
    };

    double slope(const std::vector<convergence_row>& rows, double (*of)(const convergence_row&))
    {
        double sx = 0, sy = 0, sxx = 0, sxy = 0;
        for (const auto& r : rows) {
            const double x = std::log(r.photons), y = std::log(std::max(of(r), 1e-12));
            sx += x, sy += y, sxx += x * x, sxy += x * y;
        }
        const double n = static_cast<double>(rows.size());
        return (n * sxy - sx * sy) / (n * sxx - sx * sx);
    }

    /// From values[seed][point]: bias^2 and variance, relative, without the noise of the mean and of the reference
    /// bias^2.
    convergence_row split_error(const std::vector<std::vector<double>>& values, const std::vector<double>& known,
        const std::vector<double>& known_error, double floor)
    {
        convergence_row row;
        const double seeds = static_cast<double>(values.size()), places = static_cast<double>(known.size());
        for (std::size_t i = 0; i < known.size(); ++i) {
            double mean = 0, spread = 0;
            for (const auto& v : values)
                mean += v[i] / seeds;
            for (const auto& v : values)
                spread += (v[i] - mean) * (v[i] - mean) / (seeds - 1);
            const double scale = 1 / ((known[i] + floor) * (known[i] + floor) * places);
            row.bias2
                += ((mean - known[i]) * (mean - known[i]) - spread / seeds - known_error[i] * known_error[i]) * scale;
            row.variance += spread * scale;
        }
        return row;
    }

    void print(const char* name, const std::vector<convergence_row>& rows)
    {
        std::printf("%s\n\n| photons | k | bias^2 | variance | relMSE |\n|---|---|---|---|---|\n", name);
        for (const auto& r : rows)
            std::printf("| %.0f | %.0f | %.5f | %.5f | %.5f |\n", r.photons, r.k, r.bias2, r.variance, r.total());
        const bool biased = std::all_of(rows.begin(), rows.end(),
            [](const auto& r) { return r.bias2 > 0; }); // below 0: lost in the noise taken off
        std::printf(
            biased ? "| slope | | %.2f |" : "| slope | | - |", slope(rows, [](const auto& r) { return r.bias2; }));
        std::printf(" %.2f | %.2f |\n\n", slope(rows, [](const auto& r) { return r.variance; }),
            slope(rows, [](const auto& r) { return r.total(); }));
        std::fflush(stdout);
    }

    void expect_falling(const std::vector<convergence_row>& rows)
    {
        for (std::size_t i = 1; i < rows.size(); ++i) {
            EXPECT_LT(rows[i].bias2, rows[i - 1].bias2) << rows[i].photons;
            EXPECT_LT(rows[i].variance, rows[i - 1].variance) << rows[i].photons;
        }
    }

    TEST(validation, long_smooth_irradiance_converges_at_the_rate_of_theory)
    {
        // k neighbours of N photons: variance 1 / k; the disc's area goes as k / N, and so does the bias where
        // irradiance is smooth. With k ~ N^(2/3) both squares fall as N^(-2/3).
        const facing_discs f;
        const std::vector<double> radii = {0, 0.05, 0.1, 0.15}; // about the maximum, where the bias has one sign
        const int around = 8;
        std::vector<double> known;
        for (const double r : radii)
            known.insert(known.end(), around, f.off_axis(r) * f.reflectance.x);
        std::vector<convergence_row> rows;
        for (const uint n : {2000u, 8000u, 32000u, 128000u}) {
            const auto k = static_cast<uint>(std::lround(160 * std::pow(n / 2000.0, 2.0 / 3)));
            const uint seeds = n <= 8000 ? 96 : 24; // few photons, many seeds
            std::vector<std::vector<double>> values;
            for (uint seed = 1; seed <= seeds; ++seed) {
                values.emplace_back();
                for (const auto& e : estimates_on_upper(f, circles(f, radii, around), n, k, seed))
                    values.back().push_back(static_cast<double>(e.x));
            }
            rows.push_back(split_error(values, known, std::vector<double>(known.size(), 0.0), 0));
            rows.back().photons = n;
            rows.back().k = k;
        }
        print("facing discs", rows);
        expect_falling(rows);
        EXPECT_NEAR(slope(rows, [](const auto& r) { return r.bias2; }), -2.0 / 3, 0.2);
        EXPECT_NEAR(slope(rows, [](const auto& r) { return r.variance; }), -2.0 / 3, 0.1);
        EXPECT_NEAR(slope(rows, [](const auto& r) { return r.total(); }), -2.0 / 3, 0.15);
    }

    /// Pixels of a picture that show one shape each, and which of these are far from any edge.
    class comparable_pixels {
    public:
        static constexpr double clear = 0.1; ///< m, from edges of shapes

        comparable_pixels(const scene& s, const reference_settings& settings)
            : scene_(s), settings_(settings), shapes_(s)
        {
            for (std::uint32_t y = 0; y < settings.height; ++y)
                for (std::uint32_t x = 0; x < settings.width; ++x) {
                    const auto middle = shape_at(x + 0.5, y + 0.5);
                    bool one = middle.shape != reference::nothing && middle.light == reference::nothing;
                    for (const auto& [dx, dy] : {std::pair{-0.1, -0.1}, {1.1, -0.1}, {-0.1, 1.1}, {1.1, 1.1}})
                        one = one && shape_at(x + dx, y + dy).shape == middle.shape;
                    if (!one)
                        continue;
                    whole_.push_back(std::size_t{y} * settings.width + x);
                    smooth_.push_back(is_clear(middle));
                }
        }

        /// The channels of the pixels that show one shape.
        std::vector<double> of(const image& im) const
        {
            std::vector<double> out;
            for (const auto i : whole_)
                for (int c = 0; c < 3; ++c)
                    out.push_back(static_cast<double>(im.pixels[i][c]));
            return out;
        }
        /// Of what `of` returned, what is far from edges.
        std::vector<double> smooth(const std::vector<double>& all) const
        {
            std::vector<double> out;
            for (std::size_t i = 0; i < all.size(); ++i)
                if (smooth_[i / 3])
                    out.push_back(all[i]);
            return out;
        }
        void print_counts() const
        {
            std::printf("%zu of %zu pixels lie within one shape, %td of them %.1f m from any edge\n", whole_.size(),
                std::size_t{settings_.width} * settings_.height, std::count(smooth_.begin(), smooth_.end(), true),
                clear);
        }

    private:
        reference::hit shape_at(double x, double y) const
        {
            const auto& c = scene_.camera;
            const dvec3 forward = glm::normalize(c.look_at - c.position),
                        right = glm::normalize(glm::cross(forward, c.up)), up = glm::cross(right, forward);
            const double pixel = 2 * std::tan(glm::radians(0.5 * c.vertical_fov)) / settings_.height;
            return shapes_.nearest({c.position,
                glm::normalize(
                    forward + (x - 0.5 * settings_.width) * pixel * right + (0.5 * settings_.height - y) * pixel * up),
                reference::nothing});
        }
        /// Nothing else and no edge near: there irradiance is smooth over the discs of the estimates.
        bool is_clear(const reference::hit& h) const
        {
            const dvec3 n = glm::dot(h.normal, scene_.camera.position - h.position) > 0 ? h.normal : -h.normal,
                        u = reference::across(n), v = glm::cross(n, u);
            for (int i = 0; i < 32; ++i) {
                const dvec3 way = std::cos(i * M_PI / 16) * u + std::sin(i * M_PI / 16) * v;
                if (shapes_.nearest({h.position + 1e-6 * n, way, reference::nothing}).t < clear
                    || shapes_.nearest({h.position + clear * way + 1e-3 * n, -n, reference::nothing}).shape != h.shape)
                    return false;
            }
            return true;
        }

        const scene& scene_;
        const reference_settings settings_;
        const reference::geometry shapes_;
        std::vector<std::size_t> whole_;
        std::vector<bool> smooth_; ///< of those
    };

    /// Settings for pictures of 32 x 32 pixels whose noise of direct light and edges is well below the photons'.
    render_settings settings_with_noise_of_photons_alone(const scene& s)
    {
        auto settings = with_numbers(s.render, {});
        settings.output.width = settings.output.height = 32;
        settings.output.passes = 1;
        settings.view.spp = 32;
        settings.view.light_samples = 16; // shadow rays
        settings.estimate.max_radius = 0.5;
        return settings;
    }

    TEST(validation, long_cornell_blocks_converge_to_the_reference)
    {
        auto s = read_scene(PHOTONGRID_SCENES "/cornell_blocks.json");
        auto fine = reference_settings_for(s.render);
        fine.width = fine.height = 32;
        fine.spp = 4096;
        fine.seed = 99;
        const auto exact = render_reference(s, s.camera, fine);
        // Pixels over an edge of a shape or the lamp are left out: their noise is that of 32 eye rays, whatever the
        // photons do.
        const comparable_pixels pixels(s, fine);
        const auto known = pixels.of(exact.mean), known_error = pixels.of(exact.standard_error);

        auto settings = settings_with_noise_of_photons_alone(s);
        settings.estimate.leaks = {.side = true};
        settings.estimate.edges = edge_correction::none;
        const int seeds = 8;
        std::vector<convergence_row> rows, smooth_rows, corrected_rows;
        const auto row = [&](std::vector<std::vector<double>> values, bool only_smooth) {
            if (only_smooth)
                for (auto& v : values)
                    v = pixels.smooth(v);
            auto r = split_error(values, only_smooth ? pixels.smooth(known) : known,
                only_smooth ? pixels.smooth(known_error) : known_error, 0.01);
            r.photons = settings.map.photons;
            r.k = settings.estimate.k;
            return r;
        };
        for (const uint n : {2000u, 8000u, 32000u, 128000u}) {
            settings.map.photons = n;
            settings.estimate.k = static_cast<uint>(std::lround(30 * std::pow(n / 2000.0, 2.0 / 3)));
            std::vector<std::vector<double>> values, corrected;
            for (uint seed = 1; seed <= seeds; ++seed) {
                settings.seed = seed;
                values.push_back(pixels.of(serial_picture(s, settings)));
                auto with_edges = settings;
                with_edges.estimate.leaks.min_cosine = 0.5f;
                with_edges.estimate.edges = edge_correction::polygons;
                corrected.push_back(pixels.of(serial_picture(s, with_edges)));
            }
            rows.push_back(row(values, false));
            corrected_rows.push_back(row(corrected, false));
            smooth_rows.push_back(row(values, true));
        }
        pixels.print_counts();
        print("cornell_blocks", rows);
        print("cornell_blocks, edges corrected", corrected_rows);
        print("cornell_blocks, far from edges", smooth_rows);
        expect_falling(rows);
        // Near edges discs reach over them and the bias is of order 1 in a strip as wide as the radius, N^(-1/6):
        // bias^2 of a whole room falls between that and N^(-2/3). The variance keeps its rate.
        EXPECT_NEAR(slope(rows, [](const auto& r) { return r.variance; }), -2.0 / 3, 0.2);
        EXPECT_LT(slope(rows, [](const auto& r) { return r.bias2; }), -1.0 / 6 + 0.05);
        EXPECT_LT(slope(rows, [](const auto& r) { return r.total(); }), -0.2);
        EXPECT_GT(slope(rows, [](const auto& r) { return r.total(); }), -1);
        // Far from them the picture converges to the reference at the rate of smooth irradiance.
        EXPECT_NEAR(slope(smooth_rows, [](const auto& r) { return r.total(); }), -2.0 / 3, 0.25);
        EXPECT_LT(
            std::abs(smooth_rows.back().bias2), 1e-4); // 1 % of the whole irradiance; the rest is the reference's error
        EXPECT_LT(smooth_rows.back().total(), 0.01);
    }

} // namespace
} // namespace photongrid::testing
