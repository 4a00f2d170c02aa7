// See on_serial.cpp.
#include "../estimate/edge_tests.hpp"
#include "../render/material_statistics_tests.hpp"
#include "../render/number_picture_tests.hpp"
#include "../render/progressive_tests.hpp"
#include "../render/render_tests.hpp"
#include "../render/routed_picture_tests.hpp"
#include "../render/scene_picture_tests.hpp"
#include "../render/standard_error_tests.hpp"
#include "../trace/box_tests.hpp"
#include "../trace/double_oracle_tests.hpp"
#include "../trace/light_kind_tests.hpp"
#include "../trace/media_tests.hpp"
#include "../trace/mesh_scene_tests.hpp"
#include "../trace/mixture_tests.hpp"
#include "../trace/ray_tests.hpp"
#include "../trace/texture_tests.hpp"
#include "on_serial.hpp"

#include <photongrid/reference/reference.hpp>

namespace photongrid::testing {

INSTANTIATE_TYPED_TEST_SUITE_P(serial, pictures, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, mesh_scenes, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, light_kinds, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, textures, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, mixtures, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, media, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, hard_cases_of_pictures, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, progressive, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, hard_cases, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, boxes, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, edges, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, probed_edges, ::testing::Types<serial_tag>, tag_names);
// A picture's error against the reference is bias and noise: E(N) = bias^2 + noise^2 / N for N passes. Between N and 4
// N passes 3/4 of the noise goes, whatever the bias and the reference's own error: E(1) - E(4) = 4 (E(4) - E(16)).
TEST(passes, noise_falls_with_their_number)
{
    auto s = small_cornell();
    s.spheres.clear();     // whose caustics are rare and bright
    s.render.view.spp = 2; // so that one pass has no other eye rays than each of several
    s.render.output.width = s.render.output.height = 16;
    s.render.map.photons = 1000;
    s.render.estimate.k = 40;
    s.render.output.passes = 16;
    auto fine = reference_settings_for(s.render);
    fine.spp = 256;
    fine.paths = 1 << 16;
    const auto exact = render_reference(s, s.camera, fine).mean;
    std::vector<double> gained, odd; // by three quarters of the noise of one pass; what should be 0
    for (uint block = 0; block < 16; ++block) {
        s.render.seed = block;
        double error[3] = {};
        film four, sixteen;
        for (uint pass = 0; pass < 16; ++pass) {
            auto settings = settings_of_pass(s.render, pass);
            serial_backend b;
            render_stats stats;
            const auto built = build_map(b, s, settings);
            const auto pixels = draw_pass(b, built, s.camera, settings, stats);
            film one(16, 16, 1, false);
            one.add(0, pixels);
            error[0] += relative_mse(one.picture().picture, exact) / 16;
            if (pass == 0)
                sixteen = film(16, 16, 1, false);
            if (pass % 4 == 0)
                four = film(16, 16, 1, false);
            sixteen.add(pass, pixels);
            four.add(pass, pixels);
            if (pass % 4 == 3)
                error[1] += relative_mse(four.picture().picture, exact) / 4;
        }
        error[2] = relative_mse(sixteen.picture().picture, exact);
        gained.push_back(error[0] - error[1]);
        odd.push_back(error[0] - error[1] - 4 * (error[1] - error[2]));
    }
    const auto mean_and_error = [](const std::vector<double>& v) {
        double mean = 0, variance = 0;
        for (const double x : v)
            mean += x / static_cast<double>(v.size());
        for (const double x : v)
            variance += (x - mean) * (x - mean) / static_cast<double>(v.size() - 1);
        return std::pair(mean, std::sqrt(variance / static_cast<double>(v.size())));
    };
    const auto [gain, gain_error] = mean_and_error(gained);
    const auto [rest, rest_error] = mean_and_error(odd);
    std::printf("relMSE gained by 4 passes: %.4f +- %.4f; by 16 beyond expectation: %.4f +- %.4f\n", gain, gain_error,
        rest, rest_error);
    EXPECT_GT(gain, 8 * gain_error);
    EXPECT_LT(rest_error, 0.4 * gain); // sharp enough to see noise that does not fall
    EXPECT_LT(std::abs(rest), 4 * rest_error);
}

INSTANTIATE_TYPED_TEST_SUITE_P(serial, scene_files, ::testing::Types<serial_tag>, tag_names);

} // namespace photongrid::testing
