// The light of whole pictures, by photons and by eye paths.
#pragma once

#include "landed_photons.hpp"

namespace photongrid::testing {
namespace {

    /// The sum of all pixels, of each channel, by photons and by eye paths.
    void expect_photons_equal_eye_paths(scene s)
    {
        s.render.map.photons = 60000;
        s.render.estimate.k = 150;
        s.render.estimate.max_radius = 0.3;
        s.render.output.width = s.render.output.height = 24;
        serial_backend b;
        const auto by_photons = render(b, s, s.render).picture;
        auto settings = reference_settings_for(s.render);
        settings.spp = 4096;
        settings.area_light_caustics = caustics_by::paths;
        const auto by_paths = render_reference(s, s.camera, settings);
        for (int c = 0; c < 3; ++c) {
            double photons = 0, paths = 0, variance = 0;
            for (std::size_t i = 0; i < by_photons.pixels.size(); ++i) {
                photons += static_cast<double>(by_photons.pixels[i][c]);
                paths += static_cast<double>(by_paths.mean.pixels[i][c]);
                variance += std::pow(static_cast<double>(by_paths.standard_error.pixels[i][c]), 2);
            }
            const double error = std::sqrt(variance);
            std::printf(
                "%s, channel %d: photons %.4f, eye paths %.4f +- %.4f\n", s.name.c_str(), c, photons, paths, error);
            EXPECT_LT(error, 0.005 * paths) << "too noisy to tell";
            EXPECT_NEAR(photons, paths, 4 * error + 0.01 * paths) << c;
        }
    }

} // namespace
} // namespace photongrid::testing
