// Pictures that must be equal, or nearly so: to the serial backend's, of both kinds of map, of one seed.
#pragma once

#include "pictures.hpp"

namespace photongrid::testing {

TYPED_TEST_P(pictures, long_statistics_of_a_picture_equal_serials)
{
    // For devices that round loosely, and a check of all others: over 8 seeds per side, at least 99.75 % of the means
    // over 8 x 8 pixels agree in a z-test (0.01, Sidak over the blocks).
    serial_backend serial;
    for (const auto& s : {small_cornell(), all_shapes()}) {
        const uint bx = s.render.output.width / 8, by = s.render.output.height / 8;
        const auto sample = [&](auto& device, uint first_seed) {
            std::vector<std::vector<double>> blocks(std::size_t{bx} * by * 3);
            for (uint seed = first_seed; seed < first_seed + 8; ++seed) {
                auto settings = s.render;
                settings.seed = seed;
                const auto im = render(device, s, settings).picture;
                for (uint y = 0; y < by; ++y)
                    for (uint x = 0; x < bx; ++x)
                        for (int c = 0; c < 3; ++c) {
                            double mean = 0;
                            for (uint j = 0; j < 64; ++j)
                                mean += static_cast<double>(im.pixels[(y * 8 + j / 8) * im.width + x * 8 + j % 8][c])
                                    / 64;
                            blocks[(std::size_t{y} * bx + x) * 3 + static_cast<std::size_t>(c)].push_back(mean);
                        }
            }
            return blocks;
        };
        const auto mine = sample(this->b(), 100), theirs = sample(serial, 200);
        const auto moments = [](const std::vector<double>& v) {
            double mean = 0, variance = 0;
            for (const double x : v)
                mean += x / static_cast<double>(v.size());
            for (const double x : v)
                variance += (x - mean) * (x - mean) / static_cast<double>(v.size() - 1);
            return std::pair{mean, variance / static_cast<double>(v.size())};
        };
        // Two-sided z for 1 - (1 - 0.01)^(1/n), widened by the 14 degrees of freedom of a t-test; bisection on the tail
        // of Student's distribution, since 8 seeds are few for a normal one.
        const double alpha = 1 - std::pow(1 - 0.01, 1.0 / static_cast<double>(mine.size()));
        const auto tail = [](double t) { // P(|T| > t), 14 degrees of freedom, by Simpson's rule
            const int n = 2000;
            const double top = 200, h = (top - t) / n;
            const auto density = [](double x) {
                return std::tgamma(7.5) / (std::sqrt(14 * M_PI) * std::tgamma(7)) * std::pow(1 + x * x / 14, -7.5);
            };
            double sum = density(t) + density(top);
            for (int i = 1; i < n; ++i)
                sum += density(t + i * h) * (i % 2 == 1 ? 4 : 2);
            return 2 * sum * h / 3;
        };
        double low = 0, high = 100;
        for (int i = 0; i < 60; ++i)
            (tail(0.5 * (low + high)) > alpha ? low : high) = 0.5 * (low + high);
        std::size_t accepted = 0;
        for (std::size_t i = 0; i < mine.size(); ++i) {
            const auto [a, va] = moments(mine[i]);
            const auto [c, vc] = moments(theirs[i]);
            accepted += std::abs(a - c) <= high * std::sqrt(va + vc + 1e-14) ? 1u : 0u;
        }
        EXPECT_GE(static_cast<double>(accepted), 0.9975 * static_cast<double>(mine.size()))
            << s.name << ", limit " << high;
    }
}

TYPED_TEST_P(pictures, equal_the_serial_backends)
{
    const auto a = small_cornell();
    this->expect_serial(a, a.render);
    const auto c = all_shapes();
    this->expect_serial(c, c.render);
    auto several = c.render;
    several.view.spp = 3;
    several.output.width = 24;
    several.output.height = 16;
    this->expect_serial(c, several);
}

TYPED_TEST_P(pictures, sorting_and_routing_agree)
{
    const auto s = small_cornell();
    auto settings = s.render;
    const auto sorted = this->picture(s, settings);
    settings.map.builder = map_builder::route;
    settings.map.slots = 16; // no cell overflows: the same photons in another order
    render_stats stats;
    const auto all_kept = this->picture(s, settings, &stats);
    EXPECT_EQ(stats.map.overflowing_cells, 0u);
    EXPECT_LE(relative_mse(all_kept, sorted), 1e-9); // the same photons are added in another order
    settings.map.slots = 3;
    const auto some_kept = this->picture(s, settings, &stats);
    EXPECT_GT(stats.map.overflowing_cells, 0u);
    EXPECT_GT(stats.map.redistributed_power, 0.0);
    settings.map.surplus = surplus_kind::power;
    EXPECT_LT(relative_mse(some_kept, sorted), relative_mse(this->picture(s, settings), sorted));
}

TYPED_TEST_P(pictures, the_same_seed_gives_the_same_bytes)
{
    const auto s = small_cornell();
    const auto a = this->picture(s), c = this->picture(s);
    EXPECT_TRUE(same_bytes(a, c));
    auto other = s.render;
    other.seed = 99;
    EXPECT_GT(relative_mse(this->picture(s, other), a), 1e-5);
}

} // namespace photongrid::testing
