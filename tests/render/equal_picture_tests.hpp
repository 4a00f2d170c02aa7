// Pictures that must be equal, or nearly so: to the serial backend's, of both kinds of map, of one seed.
#pragma once

#include "material_statistics.hpp"

namespace photongrid::testing {

/// For devices that round loosely, and a check of all others.
TYPED_TEST_P(pictures, long_statistics_of_a_picture_equal_serials)
{
    serial_backend serial;
    const drawing mine = [&](const scene& s, const render_settings& k) { return render(this->b(), s, k).picture; };
    const drawing theirs = [&](const scene& s, const render_settings& k) { return render(serial, s, k).picture; };
    for (const auto& s : {small_cornell(), all_shapes()})
        for (const auto& d : differences_by_material(s, s, mine, theirs)) {
            EXPECT_FALSE(d.stands_out()) << s.name << ": " << d.what << ": " << d.mean << ", limit " << d.limit;
            EXPECT_LT(d.limit, 0.01) << s.name << ": " << d.what << ": an error of 1 % would not be seen";
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
