// Sums of passes and schedules of previews: the parts of a picture, without a device.
#include "chosen_settings_tests.hpp"
#include "exact_sum_tests.hpp"
#include "film_tests.hpp"
#include "picture_error_tests.hpp"
#include "pixel_bias_tests.hpp"

#include <photongrid/render/previews.hpp>
#include <photongrid/render/render_state.hpp>
#include <photongrid/render/shrinking_radii.hpp>

namespace {

TEST(shrinking_radii, follow_their_sequence)
{
    // The product of (i - 1 + alpha) / i is Gamma(n + alpha) / (Gamma(alpha) Gamma(n + 1)).
    EXPECT_EQ(shrunk_share2(0), 1);
    EXPECT_NEAR(shrunk_share2(1), 2.0 / 3, 1e-15);
    for (const std::uint32_t n : {2u, 10u, 100u, 65535u})
        EXPECT_NEAR(shrunk_share2(n), std::exp(std::lgamma(n + 2.0 / 3) - std::lgamma(2.0 / 3) - std::lgamma(n + 1.0)),
            1e-9 * shrunk_share2(n))
            << n;
}

TEST(previews, go_from_coarse_to_fine)
{
    render_settings s;
    s.estimate.k = 500;
    const work_costs slow{.ms_per_photon = 1, .ms_per_preview_pixel = 1};
    const auto all = preview_schedule(s, s.map.photons, false, slow, 40);
    const std::vector<preview> expected{{16, 16}, {8, 16}, {4, 16}, {2, 16}, {1, 16}, {1, 4}};
    EXPECT_EQ(all, expected); // 32 pixels along the shorter side are the fewest
    EXPECT_EQ(preview_schedule(s, s.map.photons, true, slow, 40).front(), (preview{8, 16})) << "one was shown already";
    s.estimate.search = search_kind::at_least_k;
    const auto paper = preview_schedule(s, s.map.photons, false, slow, 40);
    EXPECT_EQ(paper, (std::vector<preview>{{16, 16}, {8, 16}, {4, 16}, {2, 16}}));
    s.estimate.search = search_kind::exact_k;
    s.estimate.k = 32;
    EXPECT_EQ(preview_schedule(s, s.map.photons, false, slow, 40).back(), (preview{1, 16}));
}

TEST(previews, are_as_few_as_the_time_allows)
{
    render_settings s;
    const work_costs fast{.ms_per_photon = 1e-9, .ms_per_preview_pixel = 1e-9, .ms_per_pixel = 1e-9};
    EXPECT_TRUE(preview_schedule(s, s.map.photons, false, fast, 40).empty());
    EXPECT_EQ(preview_photons(s, fast, 40), s.map.photons);
    const work_costs quick_previews{.ms_per_photon = 1e-9, .ms_per_preview_pixel = 1e-9};
    EXPECT_EQ(preview_schedule(s, s.map.photons, false, quick_previews, 40), (std::vector<preview>{{1, 16}, {1, 4}}));
}

TEST(previews, trace_fewer_photons_where_that_takes_long)
{
    render_settings s;
    s.map.photons = 1 << 20;
    const work_costs slow{.ms_per_photon = 1};
    EXPECT_EQ(preview_photons(s, slow, 40), (1u << 20) / 64);
    const work_costs medium{.ms_per_photon = 160.0 / (1 << 20)};
    EXPECT_EQ(preview_photons(s, medium, 40), 1u << 19);
    const auto early = preview_schedule(s, s.map.photons / 4, false, slow, 40);
    ASSERT_EQ(early.size(), 1u);
    EXPECT_EQ(early[0].k_divisor, 4u) << "k is smaller already";
    s.map.photons = 1000;
    EXPECT_EQ(preview_photons(s, slow, 40), 1000u) << "few are traced at once";
}

/// A picture of 4 x 12 pixels in bands of 8, 4 rows, and of 3 passes.
TEST(render_state, of_another_picture_is_refused)
{
    render_settings settings;
    settings.output.width = 4;
    settings.output.height = 12;
    settings.output.passes = 3;
    settings.output.band = 4 * 8;
    const auto with_passes = [](std::initializer_list<std::uint32_t> passes, std::uint32_t width = 4) {
        film f(width, 12, 1, false);
        for (const auto pass : passes)
            f.add(pass, random_pass(pass, std::size_t{width} * 12, false));
        return f;
    };
    const auto refusal = [&](const render_state& s) -> std::string {
        try {
            check(s, settings);
            return "";
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
    };
    const auto rows = [](std::uint32_t n) { return random_pass(0, std::size_t{4} * n, false); };
    auto band = rows(4);
    band.searches.resize(band.pixels.size());
    for (const auto& good : {render_state{}, render_state{with_passes({2, 0}), {}},
             render_state{with_passes({0, 1, 2}), {}}, render_state{with_passes({1}), {2, 8, 0, rows(8), {}}},
             render_state{with_passes({1}), {0, 12, 0, rows(12), {}}}, render_state{{}, {0, 8, 5, rows(8), band}}})
        EXPECT_EQ(refusal(good), "");
    const std::vector<std::pair<render_state, std::string>> all{
        {{with_passes({0}, 5), {}}, "film: its size or its layers differ"},
        {{with_passes({0, 1, 2, 3}), {}}, "film: 1 of its 4 passes are not the picture's"},
        {{with_passes({7}), {}}, "film: 1 of its 1 passes are not the picture's"},
        {{with_passes({1}), {1, 8, 0, rows(8), {}}}, "pass: number 1 is finished"},
        {{{}, {3, 8, 0, rows(8), {}}}, "pass: number 3 is finished or not the picture's"},
        {{{}, {0, 2, 0, rows(2), {}}}, "pass: 2 finished rows"},
        {{{}, {0, 8, 0, rows(2), {}}}, "pass: 8 finished rows"},
        {{{}, {0, 0, 0, rows(2), {}}}, "pass: 0 finished rows"},
        {{{}, {0, 16, 0, rows(16), {}}}, "pass: 16 finished rows"},
        {{{}, {0, 12, 1, rows(12), {}}}, "pass: 12 finished rows"},
        {{{}, {0, 8, 1, rows(8), rows(2)}}, "pass: the band after row 8 has another size"}};
    for (const auto& [state, words] : all)
        EXPECT_NE(refusal(state).find("render_state: " + words), std::string::npos) << words << ": " << refusal(state);
}

} // namespace
