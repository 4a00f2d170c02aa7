// What estimates are worth on the average: the expectation of every filter on a uniform field, and whether the standard
// error that an estimate reports is the spread that estimates have. On the serial backend; the others equal it bit for
// bit.
#include "../backends/serial_algorithms.hpp"
#include "../map/photon_sets.hpp"

#include <photongrid/estimate/knn_grid_estimate.hpp>

#include <gtest/gtest.h>

#include <numbers>

namespace photongrid::testing {
namespace {

    using glm::vec4;

    /// n photons of power 1/n on the unit square: the irradiance is 1 everywhere.
    map_buffers<serial_backend> uniform_field(serial_backend& b, std::size_t n, uint cells, std::uint64_t seed,
        uint slots = 0, surplus_kind surplus = surplus_kind::photons)
    {
        random_source u(seed);
        photon_set s;
        s.g = make_grid(glm::vec3(0), glm::vec3(1, 0, 1), {cells, 1, cells});
        for (std::size_t i = 0; i < n; ++i) {
            s.positions.emplace_back(u(), 0.0f, u(), 0.0f);
            s.powers.emplace_back(vec4(1.0f / static_cast<float>(n)));
        }
        if (slots > 0) // routed
            return routed_map(b, upload_photons(b, s), s.g, {slots, static_cast<uint>(seed), every_part, surplus});
        return sorted_map(b, upload_photons(b, s), s.g);
    }

    TEST(estimates, every_filter_has_expectation_one_on_a_uniform_field)
    {
        serial_backend b;
        struct row {
            search_kind search;
            bias_kind bias;
            filter_kind filter;
            uint k;
            double low, high; ///< what the mean may be
            double sum = 0, squares = 0;
        };
        std::vector<row> rows;
        for (const uint k : {32u, 100u})
            for (const auto& f : filters)
                rows.push_back({search_kind::exact_k, bias_kind::unbiased, f.kind, k, 0.995, 1.005});
        for (const auto& f : filters)
            rows.push_back({search_kind::fixed_radius, bias_kind::unbiased, f.kind, 0, 0.995, 1.005});
        rows.push_back(
            {search_kind::exact_k, bias_kind::paper, filter_kind::constant, 32, 0.995 * 32 / 31, 1.005 * 32 / 31});
        rows.push_back({search_kind::at_least_k, bias_kind::unbiased, filter_kind::constant, 32, 0.995, 1.022});
        constexpr int maps = 6, points = 6000;
        for (int m = 0; m < maps; ++m) {
            const auto map = uniform_field(b, 400000, 160, 100 + static_cast<std::uint64_t>(m));
            random_source u(static_cast<std::uint64_t>(m));
            std::vector<vec4> at;
            for (int i = 0; i < points; ++i)
                at.emplace_back(0.1f + 0.8f * u(), 0.0f, 0.1f + 0.8f * u(), 1.0f);
            const auto device_points = b.upload(std::span<const vec4>(at));
            for (auto& r : rows) {
                knn_settings s{.k = r.k, .max_radius = r.search == search_kind::fixed_radius ? 0.006f : 0.1f};
                s.search = r.search;
                s.bias = r.bias;
                s.filter = r.filter;
                for (const auto& e : b.download(knn_grid_estimate(b, map, device_points, s).irradiance)) {
                    r.sum += static_cast<double>(e.x);
                    r.squares += static_cast<double>(e.x) * static_cast<double>(e.x);
                }
            }
        }
        constexpr const char* searches[] = {"at_least_k", "exact_k", "fixed_radius"};
        std::printf("| search | bias | filter | k | mean | spread |\n|---|---|---|---|---|---|\n");
        for (const auto& r : rows) {
            const double mean = r.sum / (maps * points), spread = std::sqrt(r.squares / (maps * points) - mean * mean);
            std::printf("| %s | %s | %s | %u | %.4f | %.3f |\n", searches[static_cast<int>(r.search)],
                r.bias == bias_kind::paper ? "paper" : "unbiased", detail::entry_of(r.filter).name, r.k, mean, spread);
            EXPECT_GE(mean, r.low) << detail::entry_of(r.filter).name << " k " << r.k;
            EXPECT_LE(mean, r.high) << detail::entry_of(r.filter).name << " k " << r.k;
        }
    }

    TEST(estimates, report_the_standard_error_that_they_have)
    {
        // Over 1,000 maps, the mean of the reported error is within 10 % of the spread of the estimates.
        serial_backend b;
        struct row {
            search_kind search;
            bias_kind bias;
            filter_kind filter;
            double sum = 0, squares = 0, errors = 0;
        };
        std::vector<row> rows;
        for (const auto& f : filters)
            for (const auto search : {search_kind::exact_k, search_kind::fixed_radius, search_kind::at_least_k})
                for (const auto bias : {bias_kind::unbiased, bias_kind::paper})
                    if (bias == bias_kind::unbiased || search == search_kind::exact_k)
                        rows.push_back({search, bias, f.kind});
        const std::vector<vec4> at(1, vec4(0.5f, 0.0f, 0.5f, 1.0f));
        const auto points = b.upload(std::span<const vec4>(at));
        constexpr int maps = 1000;
        for (int m = 0; m < maps; ++m) {
            const auto map = uniform_field(b, 2000, 16, 5000 + static_cast<std::uint64_t>(m));
            for (auto& r : rows) {
                knn_settings s{.k = 50, .max_radius = r.search == search_kind::fixed_radius ? 0.09f : 0.5f};
                s.search = r.search;
                s.bias = r.bias;
                s.filter = r.filter;
                s.errors = true;
                const auto e = knn_grid_estimate(b, map, points, s);
                const auto value = static_cast<double>(b.download(e.irradiance)[0].x);
                r.sum += value;
                r.squares += value * value;
                r.errors += static_cast<double>(b.download(e.standard_error)[0].x);
            }
        }
        for (const auto& r : rows) {
            const double mean = r.sum / maps, spread = std::sqrt((r.squares - maps * mean * mean) / (maps - 1)),
                         reported = r.errors / maps;
            std::printf("search %d bias %d %s: spread %.4f, reported %.4f\n", int(r.search), int(r.bias),
                detail::entry_of(r.filter).name, spread, reported);
            EXPECT_NEAR(reported / spread, 1, 0.1)
                << "search " << int(r.search) << " bias " << int(r.bias) << " " << detail::entry_of(r.filter).name;
        }
    }

    /// Cells receive 7.8 photons on average. Where all are kept, the error is right; where one stands for s, it is
    /// right to sqrt(s) times too large, since what is known of the others is their number.
    TEST(estimates, report_too_large_errors_where_routed_cells_overflow)
    {
        serial_backend b;
        const auto points = b.upload(std::span<const vec4>(std::vector<vec4>(1, vec4(0.5f, 0.0f, 0.5f, 1.0f))));
        for (const uint slots : {1u, 2u, 3u, 5u})
            for (const auto surplus : {surplus_kind::photons, surplus_kind::power}) {
                double sum = 0, squares = 0, errors = 0;
                constexpr int maps = 1000;
                for (int m = 0; m < maps; ++m) {
                    const auto map = uniform_field(b, 2000, 16, 9000 + static_cast<std::uint64_t>(m), slots, surplus);
                    const auto e = knn_grid_estimate(
                        b, map, points, {.max_radius = 0.2f, .search = search_kind::fixed_radius, .errors = true});
                    const auto value = static_cast<double>(b.download(e.irradiance)[0].x);
                    sum += value;
                    squares += value * value;
                    errors += static_cast<double>(b.download(e.standard_error)[0].x);
                }
                // The number of photons is fixed, so that fewer outside means more inside: the spread is smaller than
                // that of independent photons by the root of the share outside.
                const double outside = 1 - std::numbers::pi * 0.2 * 0.2, mean = sum / maps,
                             spread = std::sqrt((squares - maps * mean * mean) / (maps - 1) / outside),
                             ratio = errors / maps / spread;
                // For how many a photon stands, on average over photons: n of a cell's n, where n has Poisson's
                // distribution.
                const double expected = 2000.0 / (16 * 16);
                double stands_for = 0, probability = std::exp(-expected);
                for (int n = 1; n < 60; ++n) {
                    probability *= expected / n;
                    stands_for += probability * n / expected * std::max(1.0, static_cast<double>(n) / (slots * slots));
                }
                std::printf("%u x %u slots: reported over spread %.2f, at most %.2f\n", slots, slots, ratio,
                    std::sqrt(stands_for));
                EXPECT_GE(ratio, 0.9) << slots;
                EXPECT_LE(ratio, 1.1 * std::sqrt(stands_for)) << slots;
                EXPECT_NEAR(mean, 1, 0.02) << slots;
            }
    }

    /// 320 photons in a spot and 80 far from it share a cell of 16 slots, so that a photon stands for exactly 25. k =
    /// 176 then takes all entries of the seven nearest and one of the eighth, which is left out. The share of the
    /// spot's area that the j-th nearest of n encloses has the mean inverse n / (j - 1), and 12.8 of those kept lie in
    /// the spot: the mean of the estimate is 175 / 7 * 12.8 = 320 photons over the spot's area. Taking power alone, 16
    /// photons are never 176, and the estimate spreads their power over the largest disc.
    TEST(estimates, of_routed_maps_are_as_bright_as_a_caustic)
    {
        serial_backend b;
        const auto points = b.upload(std::span<const vec4>(std::vector<vec4>(1, vec4(0.5f, 0.0f, 0.5f, 1.0f))));
        constexpr double spot = 0.1, largest = 0.4;
        const double known = 320 / (std::numbers::pi * spot * spot);
        double sum = 0, squares = 0, errors = 0;
        constexpr int maps = 1000;
        for (uint m = 0; m < maps; ++m) {
            random_source u(700 + m);
            photon_set s;
            s.g = make_grid(glm::vec3(0), glm::vec3(1, 0, 1), {1, 1, 1});
            for (int i = 0; i < 320; ++i) {
                const float r = static_cast<float>(spot) * std::sqrt(u()), angle = 6.2831853f * u();
                s.positions.emplace_back(0.5f + r * std::cos(angle), 0.0f, 0.5f + r * std::sin(angle), 0.0f);
            }
            for (int i = 0; i < 80; ++i)
                s.positions.emplace_back(0.05f * u(), 0.0f, 0.05f * u(), 0.0f);
            s.powers.assign(400, vec4(1));
            for (const auto surplus : {surplus_kind::photons, surplus_kind::power}) {
                const auto map = routed_map(b, upload_photons(b, s), s.g, {4, m, every_part, surplus});
                const auto e = knn_grid_estimate(
                    b, map, points, {.k = 176, .max_radius = static_cast<float>(largest), .errors = true});
                const auto value = static_cast<double>(b.download(e.irradiance)[0].x) / known;
                if (surplus == surplus_kind::power) {
                    EXPECT_LT(value, 1.01 * 400 / 320 * (spot * spot) / (largest * largest));
                    continue;
                }
                sum += value;
                squares += value * value;
                errors += static_cast<double>(b.download(e.standard_error)[0].x) / known;
            }
        }
        const double mean = sum / maps, spread = std::sqrt((squares - maps * mean * mean) / (maps - 1));
        std::printf("mean %.3f, spread %.3f, reported %.3f\n", mean, spread, errors / maps);
        EXPECT_NEAR(mean, 1, 4 * spread / std::sqrt(static_cast<double>(maps)));
        EXPECT_GE(errors / maps, 0.9 * spread);
    }

    TEST(estimates, the_error_of_the_channels_sum_includes_their_correlation)
    {
        serial_backend b;
        const auto map = uniform_field(b, 5000, 16, 1);
        const std::vector<vec4> at(1, vec4(0.5f, 0.0f, 0.5f, 1.0f));
        knn_settings s{.k = 50, .max_radius = 0.5f};
        s.errors = true;
        const auto e = b.download(knn_grid_estimate(b, map, b.upload(std::span<const vec4>(at)), s).standard_error)[0];
        EXPECT_NEAR(e.w, e.x + e.y + e.z, 1e-5f * e.w); // grey photons: not the root of the sum of squares
    }

} // namespace
} // namespace photongrid::testing
