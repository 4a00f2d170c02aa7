// Scenes with all kinds of lights and with textures, by photons and by eye paths.
#pragma once

#include "../trace/texture_scenes.hpp"
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

    // Colours that bleed, by way of the codes in which photons carry them.
    TEST(validation, photons_off_textures_equal_eye_paths)
    {
        auto s = textured_cornell();
        s.name = "textures";
        s.render.view.light_samples = 16;
        s.render.view.spp = 16;
        expect_photons_equal_eye_paths(s);
    }

} // namespace
} // namespace photongrid::testing
