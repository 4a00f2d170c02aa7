// Settings that nobody gave, from measures of a pilot.
#pragma once

#include <photongrid/render/chosen_settings.hpp>
#include <photongrid/scene/setting_table.hpp>

#include <gtest/gtest.h>

namespace {

using namespace photongrid;

/// Of a room with soft light and a caustic, in a picture of 256 x 256 pixels.
pilot_measures measures_of_a_room()
{
    pilot_measures m;
    m.spread = 0.02;
    m.light_spread = 0.05;
    m.maps[0] = {.spread = 0.002, .noise = 0.1, .blur2 = 0.01, .growth = 0.5, .segments = 5};
    m.maps[1] = {.spread = 0.01, .noise = 1, .blur2 = 0.001, .growth = 0.4, .segments = 3};
    m.pixels = 65536;
    m.of_ray = 1;
    m.lamps = 1;
    return m;
}

TEST(chosen_settings, are_numbers_in_their_ranges)
{
    auto automatic = automatic_settings();
    EXPECT_THROW(check_numbers(automatic), std::invalid_argument);
    EXPECT_NO_THROW(check(automatic));
    automatic.estimate.max_radius = 0.2;
    EXPECT_TRUE(is_automatic(automatic));
    const auto s = chosen_settings(measures_of_a_room(), automatic);
    EXPECT_FALSE(is_automatic(s));
    EXPECT_NO_THROW(check_numbers(s));
    EXPECT_GE(s.output.passes, 8u);
}

TEST(chosen_settings, leave_what_is_given)
{
    const auto given = [](auto&& give) {
        auto s = automatic_settings();
        give(s);
        return chosen_settings(measures_of_a_room(), s);
    };
    EXPECT_EQ(given([](auto& s) { s.map.photons = 777; }).map.photons, 777u);
    EXPECT_EQ(given([](auto& s) { s.map.caustic_photons = 0; }).map.caustic_photons, 0u);
    EXPECT_EQ(given([](auto& s) { s.estimate.k = 77; }).estimate.k, 77u);
    EXPECT_EQ(given([](auto& s) { s.estimate.caustic_k = 7; }).estimate.caustic_k, 7u);
    EXPECT_EQ(given([](auto& s) { s.estimate.max_radius = 3; }).estimate.max_radius, 3);
    EXPECT_EQ(given([](auto& s) { s.view.spp = 3; }).view.spp, 3u);
    EXPECT_EQ(given([](auto& s) { s.view.light_samples = 5; }).view.light_samples, 5u);
    EXPECT_EQ(given([](auto& s) { s.output.passes = 2; }).output.passes, 2u);
    EXPECT_LT(
        given([](auto& s) { s.view.spp = 16; }).output.passes, given([](auto& s) { s.view.spp = 1; }).output.passes);
    // Whatever ends it, it is the same picture; a rule finds no limit.
    auto timed = given([](auto& s) { s.output.seconds = 1; });
    EXPECT_EQ(timed.output.passes_at_most(), output_settings::most_passes);
    timed.output = given([](auto& s) { s.output.passes = 2; }).output;
    EXPECT_EQ(timed, given([](auto& s) { s.output.passes = 2; }));
}

TEST(chosen_settings, follow_the_light)
{
    const auto chosen = [](auto&& change) {
        auto m = measures_of_a_room();
        change(m);
        return chosen_settings(m, automatic_settings());
    };
    const auto share = [](const render_settings& s) { return 1.0 * s.estimate.k / s.map.photons; };
    const auto plain = chosen([](auto&) {});
    EXPECT_GT(chosen([](auto& m) { m.maps[1].noise *= 30; }).map.photons, plain.map.photons) << "noise of photons";
    EXPECT_LT(share(chosen([](auto& m) { m.maps[1].blur2 *= 100; })), share(plain)) << "light with edges";
    EXPECT_LT(chosen([](auto& m) { m.maps[1].segments *= 30; }).map.photons, plain.map.photons) << "dear photons";
    EXPECT_GT(chosen([](auto& m) { m.light_spread *= 30; }).view.light_samples, plain.view.light_samples);
    const auto without = chosen([](auto& m) { m.maps[0] = {}; });
    EXPECT_EQ(without.map.caustic_photons, 0u) << "no caustics";
    EXPECT_GT(plain.map.caustic_photons, 0u);
    // A map of their own for caustic photons where they need it.
    const auto in_one_map = [](double blur2) {
        return [=](auto& m) {
            m.together = {.spread = 0.012, .noise = 1.2, .blur2 = blur2, .growth = 0.4, .segments = 3};
        };
    };
    EXPECT_EQ(chosen(in_one_map(0.001)).map.caustic_photons, 0u);
    EXPECT_EQ(chosen(in_one_map(0.1)).map.caustic_photons, plain.map.caustic_photons);
    // Where eye rays alone take longer, there is time for photons too.
    EXPECT_GT(chosen([](auto& m) { m.ends = 8, m.of_ray = 5; }).map.photons, 10'000u);
}

TEST(chosen_settings, have_no_blotches_of_few_photons_whatever_blurs)
{
    auto m = measures_of_a_room();
    m.maps[1].blur2 = 10; // as where estimates of the pilot's few photons reach over all that is seen
    EXPECT_GE(chosen_settings(m, automatic_settings()).estimate.k, 32u);
}

TEST(chosen_settings, seek_more_photons_against_blotches_than_against_specks)
{
    // The same light as a caustic and as soft light.
    auto m = measures_of_a_room();
    m.maps[0] = m.maps[1];
    const auto s = chosen_settings(m, automatic_settings());
    const auto share = [](double k, double photons) { return k / photons; };
    EXPECT_GT(share(s.estimate.k, s.map.photons), 1.3 * share(s.estimate.caustic_k, s.map.caustic_photons));
}

/// Of all plans the best is taken: what is said of its error and cost is worse with any other number of photons.
TEST(chosen_settings, have_the_least_error_in_their_time)
{
    const auto m = measures_of_a_room();
    const auto best = chosen_settings(m, automatic_settings());
    const auto error = [&](double photons, double caustic) {
        detail::pass_plan plan{{caustic, photons}, {}, static_cast<double>(best.view.light_samples)};
        const double passes = 80 * m.pixels / plan.cost(m);
        for (std::size_t k = 0; k < 2; ++k)
            plan.shares[k] = detail::best_share(
                m.maps[k], plan.photons[k], passes, automatic_number, k == 1 ? detail::weight_of_blotches : 1);
        return plan.error(m, passes);
    };
    const double photons = best.map.photons, caustic = best.map.caustic_photons, least = error(photons, caustic);
    for (const double times : {0.25, 4.0}) {
        EXPECT_GT(error(photons * times, caustic), least) << times;
        EXPECT_GT(error(photons, caustic * times), least) << times;
    }
}

} // namespace
