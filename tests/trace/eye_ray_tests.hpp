// Eye rays in the strata of their pixel, on the serial backend.
#pragma once

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/trace/eye_rays.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace photongrid::testing {

/// The directions of the eye rays of one sample, pixel by pixel; a camera at `view`.
inline std::vector<glm::vec4> eye_directions(const camera& view, const render_settings& settings, uint sample)
{
    const auto all = detail::raster_of(settings, 1);
    serial_backend b;
    detail::eye_hits<serial_backend> rays(b, all.size());
    auto branches = b.make<uint>(all.size());
    b.run<kernels::eye_ray>(all.size(), detail::eye_params(view, dvec3(0), settings, all, sample), reads(),
        writes(rays.points, rays.directions, rays.throughputs, rays.surfaces, rays.emissions, branches));
    return b.download(rays.directions);
}

/// Where in a picture, in pixels from its top left, the rays of one sample go through.
inline std::vector<glm::dvec2> ray_places(const render_settings& settings, uint sample)
{
    const camera view{.position = dvec3(1, 2, 3), .look_at = dvec3(2, -1, 0), .up = dvec3(0, 1, 0), .vertical_fov = 50};
    const auto params = detail::eye_params(view, dvec3(0), settings, detail::raster_of(settings, 1), sample);
    // A direction is a multiple of corner + x right + y down.
    const auto from_direction = glm::inverse(glm::dmat3(dvec3(params.right), dvec3(params.down), dvec3(params.corner)));
    std::vector<glm::dvec2> places;
    for (const auto& d : eye_directions(view, settings, sample)) {
        const auto p = from_direction * dvec3(d);
        places.emplace_back(p.x / p.z, p.y / p.z);
    }
    return places;
}

TEST(eye_rays, each_stratum_of_a_pixel_has_one)
{
    for (const uint samples : {4u, 6u, 9u, 16u}) {
        SCOPED_TRACE(samples);
        render_settings settings;
        settings.output.width = 8;
        settings.output.height = 6;
        settings.view.spp = samples;
        const auto strata = detail::strata_of(samples);
        ASSERT_EQ(strata.x * strata.y, samples);
        std::vector<std::vector<uint>> rays(48, std::vector<uint>(samples));
        for (uint sample = 0; sample < samples; ++sample) {
            const auto places = ray_places(settings, sample);
            ASSERT_EQ(places.size(), rays.size());
            for (uint pixel = 0; pixel < places.size(); ++pixel) {
                const auto at = (places[pixel] - glm::dvec2(pixel % 8, pixel / 8)) * glm::dvec2(strata);
                ASSERT_TRUE(at.x >= 0 && at.x < strata.x && at.y >= 0 && at.y < strata.y)
                    << "outside of pixel " << pixel;
                ++rays[pixel][static_cast<uint>(at.y) * strata.x + static_cast<uint>(at.x)];
            }
        }
        for (std::size_t pixel = 0; pixel < rays.size(); ++pixel)
            EXPECT_EQ(rays[pixel], std::vector<uint>(samples, 1)) << "rays in the strata of pixel " << pixel;
    }
}

TEST(eye_rays, a_single_one_goes_through_the_middle)
{
    render_settings settings;
    settings.output.width = settings.output.height = 4;
    settings.view.spp = 1;
    settings.output.passes = 1;
    const auto places = ray_places(settings, 0);
    for (uint pixel = 0; pixel < places.size(); ++pixel) {
        EXPECT_NEAR(places[pixel].x, pixel % 4 + 0.5, 1e-5);
        EXPECT_NEAR(places[pixel].y, pixel / 4 + 0.5, 1e-5);
    }
}

} // namespace photongrid::testing
