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

/// The paper's search is left out: in a block map it ends at other radii.
TYPED_TEST_P(pictures, sorting_and_blocks_agree)
{
    const auto s = small_cornell();
    for (const auto search : {search_kind::exact_k, search_kind::fixed_radius}) {
        auto settings = s.render;
        settings.estimate.search = search;
        render_stats in_grid, in_blocks;
        const auto sorted = this->picture(s, settings, &in_grid);
        settings.map.builder = map_builder::blocks;
        const auto blocks = this->picture(s, settings, &in_blocks);
        EXPECT_LE(relative_mse(blocks, sorted), 1e-9); // the same photons are added in another order
        EXPECT_EQ(in_blocks.estimate.mean_count, in_grid.estimate.mean_count);
        EXPECT_EQ(in_blocks.map.cells, 0u);
        EXPECT_EQ(in_blocks.map.blocks, (in_blocks.photons.stored + 15) / 16);
        EXPECT_EQ(in_grid.map.blocks, 0u);
    }
}

/// Which kind suits which photons: fitted_maps_are_of_the_kind_that_suits_the_photons (block_map_tests.hpp).
TYPED_TEST_P(pictures, an_automatic_map_of_a_room_is_in_a_fitted_grid)
{
    auto s = small_cornell();
    s.render.map.builder = map_builder::automatic;
    render_stats stats;
    const auto automatic = this->picture(s, s.render, &stats);
    EXPECT_EQ(stats.map.builder, map_builder::sort);
    EXPECT_GT(stats.map.cells, 0u);
    auto fitted = s.render;
    fitted.map.builder = map_builder::sort;
    fitted.map.grid = glm::uvec3(0);
    EXPECT_TRUE(same_bytes(automatic, this->picture(s, fitted)));
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
