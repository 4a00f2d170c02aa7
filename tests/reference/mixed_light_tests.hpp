// A scene under all kinds of lights, by photons and by eye paths.
#pragma once

#include "eye_path_sums.hpp"

namespace photongrid::testing {
namespace {

    TEST(validation, photons_of_all_kinds_of_lights_equal_eye_paths)
    {
        auto s = all_lights();
        s.name = "all kinds of lights";
        s.render.view.light_samples = 16;
        s.render.view.spp = 16;
        expect_photons_equal_eye_paths(s);
    }

} // namespace
} // namespace photongrid::testing
